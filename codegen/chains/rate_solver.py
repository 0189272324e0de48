"""Integrate a compiled motion: DOP853 with the coefficients of SciPy, all of it compiled with the motion."""

from __future__ import annotations

import ctypes
from ctypes import byref, c_double, c_int, c_void_p
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import DOP853

from codegen.chains.dop853 import METHOD, POWERS, STAGES

if TYPE_CHECKING:
    from codegen.chains.rate_code import RateCode

Array = NDArray[np.float64]


class RateSolver:
    """Steps of a compiled motion.

    Args:
        code: the motion; where it is.
        t: s.
        y: what is integrated, at t.
        rates: of it there.
        end: s; no step goes beyond.
        h: s, the first step.
        relative: tolerance.
        absolute: tolerance of each.
    """

    def __init__(
        self, code: RateCode, t: float, y: Array, rates: Array, end: float, h: float, relative: float, absolute: Array
    ) -> None:
        self._code = code
        self._state: Any = _state(code.size)()
        self._state.t, self._state.end, self._state.h, self._state.relative = t, end, h, relative
        for name, values in (("y", y), ("absolute", absolute)):
            getattr(self._state, name)[:] = values.tolist()
        self._state.k[DOP853.n_stages][:] = rates.tolist()

    @property
    def t(self) -> float:
        """s, the end of the last step."""
        return float(self._state.t)

    @property
    def begun(self) -> float:
        """s, its start."""
        return float(self._state.begun)

    @property
    def h(self) -> float:
        """s, the next step."""
        return float(self._state.h)

    @property
    def y(self) -> Array:
        """What is integrated, at the end of the last step."""
        return np.array(self._state.y)

    @property
    def start(self) -> Array:
        """And at its start."""
        return np.array(self._state.start)

    def counted(self) -> tuple[int, int]:
        """Evaluations of the rates, and steps, since this was asked before."""
        found = int(self._state.evaluations), int(self._state.steps)
        self._state.evaluations = self._state.steps = 0
        return found

    def run(self, until: float) -> bool:
        """Go on to a time or beyond, or to a step behind which a switch changes; False where a step is refused."""
        function = self._code.library.jg_dop853_run
        return bool(function(byref(self._state), c_void_p(METHOD.ctypes.data), self._code.motion, c_double(until)) < 2)

    def curve(self) -> Array | None:
        """Polynomials [powers, size] of the last step, as `between` takes them; None where they are refused."""
        function = self._code.library.jg_dop853_curve
        is_found = function(byref(self._state), c_void_p(METHOD.ctypes.data), self._code.motion)
        return np.array(self._state.curve) if is_found else None


def between(curve: Array, start: Array, x: float) -> Array:
    """What is integrated within a step.

    Args:
        curve: of `RateSolver.curve`.
        start: at the start of the step.
        x: 0 at its start, 1 at its end.
    """
    found = np.zeros_like(start)
    for power in range(len(curve) - 1, -1, -1):
        found = (found + curve[power]) * (x if power % 2 == 0 else 1 - x)
    return np.asarray(start + found)


@cache
def _state(size: int) -> type[ctypes.Structure]:
    """``struct jg_solver``."""

    class State(ctypes.Structure):
        _fields_ = [
            ("t", c_double),
            ("y", c_double * size),
            ("begun", c_double),
            ("start", c_double * size),
            *((name, c_double) for name in ("h", "end", "relative")),
            ("absolute", c_double * size),
            ("k", (c_double * size) * STAGES),
            ("curve", (c_double * size) * POWERS),
            ("evaluations", c_int),
            ("steps", c_int),
        ]

    return State
