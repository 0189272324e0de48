"""What the programs give, over numpy arrays of doubles or floats."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from codegen.ir.evaluate import evaluate, numpy_domain
from codegen.ir.program import Program
from codegen.platforms.programs import program
from codegen.spec.platform import Platform

EPS = {"double": 2.0**-52, "float": 2.0**-23}
TYPES: dict[str, Any] = {"double": np.float64, "float": np.float32}


_PROGRAMS: dict[tuple[int, tuple[str, ...], str], tuple[Platform, Program]] = {}


def cached_program(platform: Platform, names: tuple[str, ...], real: str = "double") -> Program:
    """The program of a platform object; its numbers are not compared."""
    key = (id(platform), names, real)
    if key not in _PROGRAMS:
        _PROGRAMS[key] = platform, program(platform, names, real)
    return _PROGRAMS[key][1]


def found(
    platform: Platform, names: tuple[str, ...], poses: Sequence[tuple[Any, Any]], real: str = "double"
) -> dict[str, Any]:
    """Each output as [entries, poses]."""
    kind = TYPES[real]
    o = np.array([pose[0] for pose in poses], dtype=kind)
    R = np.array([pose[1] for pose in poses], dtype=kind)
    inputs = {"o": list(o.T), "R": [R[:, i, k] for k in range(3) for i in range(3)]}
    with np.errstate(all="ignore"):
        outputs = evaluate(cached_program(platform, names, real), inputs, numpy_domain())
    return {
        name: np.array([np.broadcast_to(np.asarray(value, dtype=kind), len(poses)) for value in values])
        for name, values in outputs.items()
    }
