"""The in-line engine of S1: the piston's motion in both formulations, work and precision, and time by size."""
