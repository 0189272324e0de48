"""The engine in other programs: each gives the positions of the bodies of the first engine, [outputs + 1, 3, 2] m."""
