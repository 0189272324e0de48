"""The in-line engine (S1 section 5) as numbers: three revolute joints and one translational, of the library's routines.

Bodies are crank, rod and piston; dimensions are those of ``examples/in_line_engine.toml``.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from codegen.emit.routine import Routine
from codegen.ir.evaluate import evaluate
from codegen.measure.attitudes import turned
from codegen.spec.request import Variant
from codegen.trade.extreme_table import routine_of

Array = NDArray[np.float64]

CRANK, ROD = 0.1, 0.3
"""Lengths, m."""

_ALONG_X = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
"""Joint frame with its third axis along x."""


@dataclass(frozen=True, slots=True, eq=False)
class Pose:
    """Crank, rod, piston: ``r`` [3, 3], ``A`` [3, 3, 3]; joint coordinates [4], multipliers [24]."""

    r: Array
    A: Array
    alpha: Array
    lam: Array


@dataclass(frozen=True, slots=True)
class Place:
    """A joint: type, bodies (None: ground), attachment points on x and frame on both bodies."""

    type: str
    bodies: tuple[int | None, int]
    points: tuple[float, float]
    frame: Array


JOINTS = (
    Place("revolute", (None, 0), (0.0, -CRANK / 2), np.eye(3)),
    Place("revolute", (0, 1), (CRANK / 2, -ROD / 2), np.eye(3)),
    Place("revolute", (1, 2), (ROD / 2, 0.0), np.eye(3)),
    Place("translational", (None, 2), (0.0, 0.0), _ALONG_X),
)


def closed(angle: float) -> Pose:
    """The closed engine at an angle of the crank, rad; dead centres are at 0 and half a turn."""
    tilt = -math.asin(CRANK / ROD * math.sin(angle))
    pin = CRANK * np.array([math.cos(angle), math.sin(angle), 0.0])
    end = np.array([pin[0] + ROD * math.cos(tilt), 0.0, 0.0])
    A = turned(np.stack([np.eye(3)] * 3), np.array([[0, 0, angle], [0, 0, tilt], [0, 0, 0.0]]))
    alpha = np.array([angle, tilt - angle, -tilt, end[0]])
    return Pose(np.array([pin / 2, (pin + end) / 2, end]), A, alpha, np.zeros(24))


def inputs(place: Place, now: Pose, k: int) -> dict[str, list[float]]:
    """Arguments of the routines of joint ``k`` at a pose."""
    i, j = place.bodies
    points = [np.array([point, 0.0, 0.0]) for point in place.points]
    frames = [part for point in points for part in (point, place.frame.ravel(order="F"))]
    found = {
        "r_i": np.zeros(3) if i is None else now.r[i],
        "A_i": (np.eye(3) if i is None else now.A[i]).ravel(order="F"),
        "r_j": now.r[j],
        "A_j": now.A[j].ravel(order="F"),
        "alpha": now.alpha[k : k + 1],
        "geometry": np.concatenate(frames),
        "lambda": now.lam[6 * k : 6 * k + 6],
    }
    return {name: [float(x) for x in values] for name, values in found.items()}


def columns(place: Place, k: int) -> Iterator[tuple[slice, slice]]:
    """Columns of a joint and of the whole: its bodies that move, its coordinate."""
    for side, body in enumerate(place.bodies):
        if body is not None:
            yield slice(6 * side, 6 * side + 6), slice(6 * body, 6 * body + 6)
    yield slice(12, 13), slice(18 + k, 19 + k)


def dense(routine: Routine, given: dict[str, list[float]]) -> Array:
    """The only output of a routine as a matrix."""
    (output,) = routine.straight.outputs
    matrix = np.zeros((output.sparsity.nrow, output.sparsity.ncol))
    for (row, column), value in zip(
        output.sparsity.entries(), evaluate(routine.straight, given)[output.name], strict=True
    ):
        matrix[row, column] = value
    return matrix


def jacobian(form: str, rows: str | None, now: Pose) -> Array:
    """``phi_q`` of the engine at a pose: rows of all joints by 18 displacements and, if parametric, 4 coordinates."""
    blocks = []
    for k, place in enumerate(JOINTS):
        own = dense(routine_of(Variant(place.type, form, rows), "phi_q"), inputs(place, now, k))
        block = np.zeros((len(own), 22))
        for part, whole in columns(place, k):
            if own[:, part].size:
                block[:, whole] += own[:, part]
        blocks.append(block)
    return np.vstack(blocks)[:, : 22 if form == "parametric" else 18]
