"""The functions of SUNDIALS that a run needs, from the libraries that scikit-sundae brings.

They are called through ctypes, so that IDA takes all steps up to an output time without a detour through Python.
"""

from __future__ import annotations

import ctypes
import importlib.util
from collections.abc import Iterator
from contextlib import contextmanager
from ctypes import POINTER, byref, c_double, c_int, c_long, c_void_p
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from codegen.errors import Mistake, SpecificationError

REMEDY = "pip install 'jointgen[simulate]'"

_LIBRARIES = ("core", "nvecserial", "sunmatrixsparse", "sunmatrixdense", "sunlinsoldense", "ida")

_SIGNATURES: dict[str, tuple[Any, tuple[Any, ...]]] = {
    "SUNContext_Create": (c_int, (c_int, POINTER(c_void_p))),
    "SUNContext_Free": (c_int, (POINTER(c_void_p),)),
    "SUNContext_ClearErrHandlers": (c_int, (c_void_p,)),
    "N_VMake_Serial": (c_void_p, (c_int, c_void_p, c_void_p)),
    "N_VEnableLinearCombination_Serial": (c_int, (c_void_p, c_int)),
    "N_VDestroy": (None, (c_void_p,)),
    "SUNSparseMatrix": (c_void_p, (c_int, c_int, c_int, c_int, c_void_p)),
    "SUNMatDestroy": (None, (c_void_p,)),
    "SUNDenseMatrix": (c_void_p, (c_int, c_int, c_void_p)),
    "SUNLinSol_Dense": (c_void_p, (c_void_p, c_void_p, c_void_p)),
    "SUNLinSolFree": (c_int, (c_void_p,)),
    "SUNLinSolNewEmpty": (c_void_p, (c_void_p,)),
    "SUNLinSolFreeEmpty": (None, (c_void_p,)),
    "IDACreate": (c_void_p, (c_void_p,)),
    "IDAFree": (None, (POINTER(c_void_p),)),
    "IDAInit": (c_int, (c_void_p, c_void_p, c_double, c_void_p, c_void_p)),
    "IDAReInit": (c_int, (c_void_p, c_double, c_void_p, c_void_p)),
    "IDASVtolerances": (c_int, (c_void_p, c_double, c_void_p)),
    "IDASetUserData": (c_int, (c_void_p, c_void_p)),
    "IDASetId": (c_int, (c_void_p, c_void_p)),
    "IDASetSuppressAlg": (c_int, (c_void_p, c_int)),
    "IDASetMaxNumSteps": (c_int, (c_void_p, c_long)),
    "IDASetMaxOrd": (c_int, (c_void_p, c_int)),
    "IDASetMaxStep": (c_int, (c_void_p, c_double)),
    "IDASetInitStep": (c_int, (c_void_p, c_double)),
    "IDASetNonlinConvCoef": (c_int, (c_void_p, c_double)),
    "IDASetDeltaCjLSetup": (c_int, (c_void_p, c_double)),
    "IDASetEtaFixedStepBounds": (c_int, (c_void_p, c_double, c_double)),
    "IDASetStopTime": (c_int, (c_void_p, c_double)),
    "IDASetLinearSolver": (c_int, (c_void_p, c_void_p, c_void_p)),
    "IDASetJacFn": (c_int, (c_void_p, c_void_p)),
    "IDASolve": (c_int, (c_void_p, c_double, POINTER(c_double), c_void_p, c_void_p, c_int)),
    "IDAGetNumSteps": (c_int, (c_void_p, POINTER(c_long))),
    "IDAGetNumResEvals": (c_int, (c_void_p, POINTER(c_long))),
    "IDAGetNumJacEvals": (c_int, (c_void_p, POINTER(c_long))),
    "IDAGetNumNonlinSolvIters": (c_int, (c_void_p, POINTER(c_long))),
    "IDAGetNumErrTestFails": (c_int, (c_void_p, POINTER(c_long))),
    "IDAGetNumStepSolveFails": (c_int, (c_void_p, POINTER(c_long))),
}

_VECTOR_WORDS = 40
"""Of the operations of a vector that are looked through; all versions have more."""

VECTOR_OPERATIONS = (
    "N_VLinearSum_Serial",
    "N_VConst_Serial",
    "N_VScale_Serial",
    "N_VAbs_Serial",
    "N_VInv_Serial",
    "N_VWrmsNorm_Serial",
    "N_VWrmsNormMask_Serial",
    "N_VLinearCombination_Serial",
)
"""Operations of serial vectors that compiled code has for its own length."""


def _words(address: int, count: int = 12) -> Any:
    """Words of a vector or a linear solver, or of its operations; only those are read that every version has."""
    return (c_void_p * count).from_address(address)


class Sundials:
    """The functions by their names, and addresses of those that compiled code calls."""

    def __init__(self, libraries: list[ctypes.CDLL]) -> None:
        self._libraries = libraries
        self._found: tuple[int, tuple[int, ...]] | None = None
        self._places: tuple[int, tuple[int, ...]] | None = None
        for name, (result, arguments) in _SIGNATURES.items():
            function = self._find(name)
            function.restype = result
            function.argtypes = arguments
            setattr(self, name, function)

    @cache  # noqa: B019 - the one instance lives as long as the program
    def address(self, name: str) -> int:
        """Address of a function."""
        return ctypes.cast(self._find(name), c_void_p).value or 0

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(name)

    def _find(self, name: str) -> Any:
        for library in self._libraries:
            try:
                return library[name]
            except AttributeError:
                continue
        raise SpecificationError([Mistake("SUNDIALS", f"its libraries have no {name}", REMEDY)])

    def replace_operations(self, vector: int, operations: tuple[int, ...]) -> None:
        """Give a serial vector, and those that are cloned from it, operations of its own.

        Args:
            vector: of ``N_VMake_Serial``.
            operations: addresses, in the order of `VECTOR_OPERATIONS`.

        Raises:
            SpecificationError: the layout is not understood.
        """
        self.N_VEnableLinearCombination_Serial(vector, 1)
        if self._places is None:
            table = next((k for k in (1, 2) if _words(vector)[k]), 1)
            found = list(_words(_words(vector)[table], _VECTOR_WORDS))
            known = [self.address(name) for name in VECTOR_OPERATIONS]
            if not set(known) <= set(found):
                raise SpecificationError([Mistake("SUNDIALS", "its vectors have an unknown layout", REMEDY)])
            self._places = table, tuple(found.index(address) for address in known)
        table, places = self._places
        words = _words(_words(vector)[table], _VECTOR_WORDS)
        for place, operation in zip(places, operations, strict=True):
            words[place] = operation

    def entries_word(self, vector: int, entries: int) -> int:
        """Say which word of the content of a vector points to its entries, by a vector whose entries are known."""
        return list(_words(_words(vector)[0], 3)).index(entries)

    def linear_solver(self, context: c_void_p, content: int, setup: int, solve: int) -> c_void_p:
        """Make a direct linear solver of two compiled operations; `SUNLinSolFreeEmpty` gives its memory back.

        Where the operations stand depends on the version of SUNDIALS; it is read off a solver that SUNDIALS makes,
        whose operations are known by their addresses.

        Args:
            context: of SUNDIALS.
            content: address that the operations find first in the solver.
            setup: address of the factorisation.
            solve: address of the solution.

        Raises:
            SpecificationError: the layout is not understood.
        """
        table, places = self._layout(context)
        made = self.SUNLinSolNewEmpty(context)
        _words(made)[0] = content
        operations = (self.address("SUNLinSolGetType_Dense"), setup, solve)
        for place, operation in zip(places, operations, strict=True):
            _words(_words(made)[table])[place] = operation
        return c_void_p(made)

    def _layout(self, context: c_void_p) -> tuple[int, tuple[int, ...]]:
        """Where a solver has its operations, and where among them type, factorisation and solution stand."""
        if self._found is None:
            kind, *known = (self.address(f"SUNLinSol{name}_Dense") for name in ("GetType", "Setup", "Solve"))
            with self._dense_solver(context) as dense:
                table = next((k for k in (1, 2) if dense[k] and _words(dense[k])[0] == kind), None)
                operations = [] if table is None else list(_words(dense[table]))
            if table is None or not set(known) <= set(operations):
                raise SpecificationError([Mistake("SUNDIALS", "its linear solvers have an unknown layout", REMEDY)])
            self._found = table, tuple(operations.index(address) for address in (kind, *known))
        return self._found

    @contextmanager
    def _dense_solver(self, context: c_void_p) -> Iterator[Any]:
        entry = np.zeros(1)
        vector, matrix = self.N_VMake_Serial(1, entry.ctypes.data, context), self.SUNDenseMatrix(1, 1, context)
        solver = self.SUNLinSol_Dense(vector, matrix, context)
        yield _words(solver)
        self.SUNLinSolFree(solver)
        self.SUNMatDestroy(matrix)
        self.N_VDestroy(vector)

    def statistic(self, name: str, memory: c_void_p) -> int:
        """Read a counter of a run."""
        value = c_long()
        getattr(self, name)(memory, byref(value))
        return value.value


@cache
def sundials() -> Sundials:
    """Load the libraries.

    Raises:
        SpecificationError: scikit-sundae is not installed, or brings no libraries.
    """
    found = importlib.util.find_spec("sksundae")
    if found is None or found.origin is None:
        raise SpecificationError([Mistake("simulate", "scikit-sundae is not installed", REMEDY)])
    importlib.import_module("sksundae.ida")  # loads what the libraries depend on
    folder = Path(found.origin).parent.parent / "scikit_sundae.libs"
    paths = [next(iter(sorted(folder.glob(f"libsundials_{name}-*"))), None) for name in _LIBRARIES]
    if None in paths:
        raise SpecificationError(
            [Mistake("simulate", "the installed scikit-sundae brings no SUNDIALS libraries", REMEDY)]
        )
    return Sundials([ctypes.CDLL(str(path)) for path in paths])
