"""The method DOP853 with the coefficients of SciPy, as the C that is compiled with a motion takes it."""

from __future__ import annotations

import numpy as np
from scipy.integrate import DOP853

import codegen
from codegen.emit.environment import render
from codegen.emit.package import banner

POWERS = 3 + len(DOP853.D)
"""Polynomials of the curve of a step."""

STAGES = DOP853.D.shape[1]
"""Rates that a step and its curve take."""

METHOD = np.concatenate(
    [
        np.ravel(part)
        for part in (DOP853.A, DOP853.B, DOP853.C, DOP853.E3, DOP853.E5, DOP853.A_EXTRA, DOP853.C_EXTRA, DOP853.D)
    ]
)
"""``struct jg_method``."""


def header() -> str:
    """The header ``jg_dop853.h``."""
    sizes = {"stages": DOP853.n_stages, "more": len(DOP853.C_EXTRA), "powers": POWERS}
    return render("simulate/jg_dop853.h.j2", banner=banner(codegen.__version__), **sizes)
