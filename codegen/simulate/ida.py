"""IDA on compiled equations: variable-order, variable-step BDF, the linear algebra compiled with the equations."""

from __future__ import annotations

import ctypes
import math
from ctypes import byref, c_double, c_long, c_void_p
from dataclasses import dataclass
from types import TracebackType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from codegen.errors import InternalError
from codegen.simulate.compiled import Compiled
from codegen.simulate.sundials import sundials

Array = NDArray[np.float64]

_CSC, _NORMAL, _ONE_STEP = 0, 1, 2

_STEPS, _ROUNDS = 10_000, 1_000
"""Steps that IDA takes at a time, and how often on the way to one output time."""

_TOO_MANY = -1

FAILURES = {
    _TOO_MANY: "took too many steps",
    -2: "cannot reach the accuracy asked for",
    -3: "failed the error test too often, or its step became too small",
    -4: "stopped: Newton's iteration did not converge, or the step became too small",
    -5: "cannot set up the linear solver",
    -6: "cannot solve the linear system: the Jacobian is singular",
    -8: "cannot evaluate the residual",
    -9: "finds a residual that is no number wherever a step leads",
}
"""Return codes of IDASolve in words."""


NEWTON = 0.03
"""How far below the error test Newton's iteration ends; IDA's own choice is 0.33.

What is left of the iteration is noise in the test: with 0.33 it refuses steps that are good, and the run takes half as
many steps again for an error several times as large.
"""

AGE = 0.05
"""How far the weight of the rates may move before the Newton matrix is factorised anew; IDA's own choice is 0.25.

With the present matrix one iteration is nearly exact, so that steps depend on the mechanism and the tolerance, not on
what iterations leave over: the same ones in every form and for any number of equal mechanisms.
"""

LEAST_GROWTH = 1.2
"""A step grows if it may by this factor; IDA's own choice is 2, for matrices that are dear."""

STEP_SHARE = 0.1
"""What a step may have of the tolerance: errors of thousands of steps add up."""


@dataclass(frozen=True, slots=True)
class Tolerances:
    """What the error test asks for: the mean error of the entries that are tested, in a step.

    Attributes:
        relative: of every entry.
        absolute: [n] of each entry.
    """

    relative: float
    absolute: Array


@dataclass(frozen=True, slots=True)
class Statistics:
    """Counters of a run."""

    steps: int
    residuals: int
    jacobians: int
    newton_iterations: int
    error_test_failures: int
    convergence_failures: int


class _Hooks(ctypes.Structure):
    """``struct jg_ida`` of the compiled source."""

    _fields_ = [
        ("data", c_void_p),
        ("entries_word", c_long),
        *((name, c_void_p) for name in ("revolutions", "kinds", "kind", "lu")),
    ]


_START = ctypes.CFUNCTYPE(ctypes.c_int, c_void_p)
_END = ctypes.CFUNCTYPE(None, c_void_p)


class Ida:
    """A run of IDA; use it as a context, so that its memory is given back.

    Args:
        equations: compiled.
        t: s, at the start.
        y: [n] state at the start, consistent.
        ydot: [n] its rate.
        identity: [n] 1 where the rate of an entry is in the residual, 0 elsewhere.
        tolerances: of the error test; entries whose rate is not in the residual are left out of it.
        largest_step: s; 0 for none.
        revolutions: whole turns of conventional screws.
    """

    def __init__(
        self,
        equations: Compiled,
        t: float,
        y: Array,
        ydot: Array,
        identity: Array,
        tolerances: Tolerances,
        largest_step: float = 0.0,
        revolutions: Array | None = None,
    ) -> None:
        self._library = sundials()
        self._equations = equations
        self._start = t
        self.y, self.ydot = np.array(y, dtype=np.float64), np.array(ydot, dtype=np.float64)
        self._identity = np.array(identity, dtype=np.float64)
        # IDA's norm is the mean of all entries, with 0 for those that are not tested.
        share = STEP_SHARE * math.sqrt(self._identity.sum() / len(self._identity))
        self._absolute = share * np.array(tolerances.absolute, dtype=np.float64)
        self._turns = np.array([0.0] if revolutions is None or not len(revolutions) else revolutions, dtype=np.float64)
        straight = equations.straight
        self._hooks = _Hooks(
            self._library.address("SUNSparseMatrix_Data"),
            0,
            self._turns.ctypes.data,
            straight.kinds,
            straight.kind.ctypes.data,
        )
        self._context = c_void_p()
        self._create(t, share * tolerances.relative, largest_step)

    def _create(self, t: float, relative: float, largest_step: float) -> None:
        library, size = self._library, self._equations.size
        self._check(library.SUNContext_Create(0, byref(self._context)))
        library.SUNContext_ClearErrHandlers(self._context)
        arrays = (self.y, self.ydot, self._absolute, self._identity)
        self._vectors = [library.N_VMake_Serial(size, array.ctypes.data, self._context) for array in arrays]
        y, ydot, absolute, identity = self._vectors
        library.replace_operations(y, self._equations.operations)  # all vectors of IDA are cloned from it
        self._hooks.entries_word = library.entries_word(y, self.y.ctypes.data)
        self._check(_START(self._equations.start)(ctypes.addressof(self._hooks)))
        self._matrix = library.SUNSparseMatrix(size, size, self._equations.nonzeros, _CSC, self._context)
        self._solver = library.linear_solver(
            self._context, ctypes.addressof(self._hooks), self._equations.setup, self._equations.solve
        )
        self._memory = c_void_p(library.IDACreate(self._context))
        self._check(library.IDAInit(self._memory, self._equations.residual, t, y, ydot))
        self._check(library.IDASVtolerances(self._memory, relative, absolute))
        self._check(library.IDASetUserData(self._memory, ctypes.addressof(self._hooks)))
        self._check(library.IDASetId(self._memory, identity))
        self._check(library.IDASetSuppressAlg(self._memory, 1))
        self._check(library.IDASetMaxNumSteps(self._memory, _STEPS))
        self._check(library.IDASetNonlinConvCoef(self._memory, NEWTON))
        self._check(library.IDASetDeltaCjLSetup(self._memory, AGE))
        self._check(library.IDASetEtaFixedStepBounds(self._memory, 1.0, LEAST_GROWTH))
        self._first_step = self._meeting_test(relative)
        if largest_step:
            self._check(library.IDASetMaxStep(self._memory, largest_step))
        self._check(library.IDASetLinearSolver(self._memory, self._solver, self._matrix))
        self._check(library.IDASetJacFn(self._memory, self._equations.jacobian))

    def _meeting_test(self, relative: float) -> float:
        """A step of first order that meets the error test, s; 0 where nothing tells.

        What changes in ``tau`` has ``norm(ydot) / tau`` for a second derivative. IDA's own choice, ``1 / norm(ydot)``,
        is four orders smaller, and some twenty steps follow until the size is right.
        """
        weights = self._identity / (relative * np.abs(self.y) + self._absolute)
        size, rate = (math.sqrt(x @ x / len(x)) for x in (weights * self.y, weights * self.ydot))
        return math.sqrt(size) / rate if size and rate else 0.0

    def advance(self, t: float) -> tuple[float, int]:
        """Go on to a time; ``y`` and ``ydot`` are then those at the time reached.

        Returns:
            The time reached, and 0 or one of `FAILURES`.
        """
        if self._first_step:  # at most as far as the first output
            self._check(self._library.IDASetInitStep(self._memory, min(self._first_step, t - self._start)))
            self._first_step = 0.0
        reached = c_double()
        y, ydot = self._vectors[:2]
        code = _TOO_MANY
        for _ in range(_ROUNDS):  # an interruption is heeded between two of them
            code = self._library.IDASolve(self._memory, t, byref(reached), y, ydot, _NORMAL)
            if code != _TOO_MANY:
                break
        return reached.value, min(code, 0)

    def statistics(self) -> Statistics:
        """Counters so far."""
        names = (
            "IDAGetNumSteps",
            "IDAGetNumResEvals",
            "IDAGetNumJacEvals",
            "IDAGetNumNonlinSolvIters",
            "IDAGetNumErrTestFails",
            "IDAGetNumStepSolveFails",
        )
        return Statistics(*(self._library.statistic(name, self._memory) for name in names))

    def __enter__(self) -> Ida:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        library: Any = self._library
        library.IDAFree(byref(self._memory))
        library.SUNLinSolFreeEmpty(self._solver)
        _END(self._equations.end)(ctypes.addressof(self._hooks))
        library.SUNMatDestroy(self._matrix)
        for vector in self._vectors:
            library.N_VDestroy(vector)
        library.SUNContext_Free(byref(self._context))

    @staticmethod
    def _check(code: int) -> None:
        if code:
            raise InternalError(f"SUNDIALS refuses a setting with {code}")
