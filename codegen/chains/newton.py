"""What Newton's method takes for a step, a solution and a path that stays on its branch: in Python and compiled alike.

Lengths and angles: rad, or characteristic lengths.
"""

from __future__ import annotations

LARGEST_STEP = 0.5
"""No coordinate changes by more in one iteration."""

STEP = 1e-10
"""The last step is smaller. Newton squares it: the pose is known to rounding."""

RESIDUAL = 1e-12
"""Every row is smaller at a solution, times the size of coordinates and lengths."""

CONTRACTION = 0.25
"""The second step is smaller than this part of the first (after Deuflhard), unless both are tiny."""

TINY = 1e-6
"""A first step that needs not contract."""

PREDICTED = 0.3
"""No coordinate is predicted further along a path, so that angles keep their turns."""

CORRECTED = 0.1
"""No coordinate is corrected further behind a prediction."""

ITERATIONS = 12
"""At most, along a path."""
