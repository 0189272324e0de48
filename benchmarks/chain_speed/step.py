"""A whole step of inverse dynamics beside the generic one: recursion, pseudo-inverse by SVD of all rows.

Both are C and call the LAPACK that SciPy brings. From coordinates, rates and independent accelerations they give
accelerations, efforts and reactions. Ours: the generated routine, then the rows that bind as `codegen.chains.factor`
has them, LU with the condition number where they are square, else QR with pivoting. Generic: the recursion,
``dgesdd`` of all six rows of each cut, the pseudo-inverse multiplied out, as `numpy.linalg.pinv` does.
"""

from __future__ import annotations

import ctypes
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cython_lapack
from threadpoolctl import threadpool_limits

from benchmarks.chain_speed.measure import FLAGS, HERE, fused_entry, rendered
from codegen.chains.generate import generate_chain
from codegen.measure.compile import compile_sources
from codegen.mechanics.chain.model import kept_rows
from codegen.spec.chain import Chain

ROUNDS = 301
_BLOCK = 100
"""Steps of a round."""

_TOLERANCE = 1e-9
"""By which efforts and reactions may differ, relative: two ways to solve."""


@dataclass(frozen=True, slots=True)
class Step:
    """Time of one step, and the largest relative difference of efforts and reactions.

    Attributes:
        routine: ns, median.
        generic: ns, median.
        ratio: median of routine over generic, round by round.
        difference: largest, relative to the largest effort or reaction.
    """

    routine: float
    generic: float
    ratio: float
    difference: float


def step(chain: Chain, folder: Path) -> Step:
    """Time a step of a chain in the pose of its file.

    Args:
        chain: its cuts are closed, their C frames stand on the base.
        folder: for what is compiled.

    Raises:
        ArithmeticError: the two do not agree.
    """
    library = _library(chain, folder)
    routine, generic = _values(library, chain, "by_routine"), _values(library, chain, "by_recursion")
    difference = float(np.abs(routine - generic).max() / np.abs(generic).max())
    if not difference < _TOLERANCE:
        raise ArithmeticError(f"{chain.name}: steps differ by {difference:.1e}")
    library.nanoseconds.restype = ctypes.c_double
    with threadpool_limits(1):
        times = np.array([[library.nanoseconds(side, _BLOCK) for side in (0, 1)] for _ in range(ROUNDS)])
    routine_time, generic_time = map(float, np.median(times, axis=0))
    return Step(routine_time, generic_time, float(np.median(times[:, 0] / times[:, 1])), difference)


def _library(chain: Chain, folder: Path) -> ctypes.CDLL:
    files = generate_chain(chain)
    for name in (f"{chain.name}.h", f"{chain.name}.c", "jg_real.h"):
        (folder / name).write_bytes(files[name])
    for name in ("table_driven.h", "table_driven.c"):
        (folder / name).write_text((HERE / name).read_text())
    (folder / "table.h").write_text(rendered("table.h.j2", chain))
    (folder / "step.c").write_text(rendered("step.c.j2", chain, **_layout(chain, fused_entry(files, chain))))
    sources = [folder / name for name in ("step.c", "table_driven.c", f"{chain.name}.c")]
    compile_sources(sources, folder / "step.so", (*FLAGS, "-fPIC", "-shared"))
    library = ctypes.CDLL(str(folder / "step.so"))
    for name in ("getrf", "getrs", "geqp3", "orgqr", "trtrs", "gesdd"):
        ctypes.c_void_p.in_dll(library, name).value = _address(f"d{name}")
    return library


def _layout(chain: Chain, entry: Mapping[str, Any]) -> dict[str, Any]:
    """Numbers of rows and coordinates, whether J_w is square, and where the stored entries of J and M stand."""
    v = [chain.index(one.joint) for one in chain.independents]
    rows, w = list(kept_rows(chain)), [k for k in range(len(chain.links)) if k not in v]
    found: dict[str, Any] = {"rows": rows, "v": v, "w": w, "is_square": len(rows) == len(w)}
    for name in ("J", "M"):
        pattern = entry["sparsity"][name]
        found[f"{name}_row"] = pattern["row"]
        found[f"{name}_column"] = np.repeat(np.arange(pattern["ncol"]), np.diff(pattern["colind"])).tolist()
    return found


def _address(name: str) -> int | None:
    """Where a routine of LAPACK is."""
    capsule = cython_lapack.__pyx_capi__[name]
    api = ctypes.pythonapi
    api.PyCapsule_GetName.restype, api.PyCapsule_GetName.argtypes = ctypes.c_char_p, [ctypes.py_object]
    api.PyCapsule_GetPointer.restype = ctypes.c_void_p
    api.PyCapsule_GetPointer.argtypes = [ctypes.py_object, ctypes.c_char_p]
    found: int | None = api.PyCapsule_GetPointer(capsule, api.PyCapsule_GetName(capsule))
    return found


def _values(library: ctypes.CDLL, chain: Chain, name: str) -> NDArray[np.float64]:
    """Efforts and reactions by one of the two."""
    if getattr(library, name)():
        raise ArithmeticError(f"{chain.name}: {name} fails")
    sizes = {"effort": len(chain.independents), "f_R": 6 * len(chain.cuts)}
    return np.concatenate([np.array((ctypes.c_double * size).in_dll(library, n)) for n, size in sizes.items()])
