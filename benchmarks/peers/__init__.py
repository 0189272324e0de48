"""The same joint routines from other code generators and by hand, checked, counted and timed beside ours."""
