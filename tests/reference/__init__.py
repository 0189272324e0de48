"""Independent truth for the joint routines, written from SPEC S1 alone; imports nothing of the product."""
