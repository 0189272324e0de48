"""Newton-Raphson on the dependent coordinates: phi(q_v, q_w) = 0.

phi is (p; 2e) of every cut with its exact derivative; where a cut is turned by more than 120 degrees, the rotation
vector takes the place of 2e, since its derivative is regular at half turns too. Both the step and the residual must be
small at the end; a least-squares solution that leaves a residual is no solution.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg
import scipy.optimize
from numpy.typing import NDArray

from codegen.chains.equations import Closure, Equations
from codegen.chains.factor import Factor, RankLoss, factor
from codegen.chains.newton import LARGEST_STEP, RESIDUAL, STEP
from codegen.chains.partition import Partition
from codegen.chains.rotation import quaternion, rotation_vector, rotation_vector_slope, skew

Array = NDArray[np.float64]

_ITERATIONS = 60
_STALLED = 8
"""Iterations without a residual smaller than the best before, after which there is no hope."""


@dataclass(frozen=True, slots=True, eq=False)
class Position:
    """Where the iteration ended.

    Attributes:
        q: [n].
        residual: largest row of phi, rad or characteristic lengths.
        row: the number of that row.
        is_closed: whether both stop tests are met.
        slope: [6 nr, n] derivative of phi at the last iterate but one, which is at most `STEP` away.
        factor: of its dependent columns, without dimension; None where its rank is lost.
        iterations: done.
        contraction: size of the second step beside the first; 0 where one was enough.
        correction: largest change of a coordinate from the guess.
    """

    q: Array
    residual: float
    row: int
    is_closed: bool
    slope: Array
    factor: Factor | None
    iterations: int
    contraction: float
    correction: float


def constraint(closure: Closure) -> tuple[Array, Array]:
    """Give phi [6 nr] and its derivative [6 nr, n]."""
    phi, slope = [], []
    for p, R, dp, W in zip(closure.p, closure.R, closure.dp, closure.W, strict=True):
        e = quaternion(R)
        phi.append(p)
        slope.append(dp)
        if e[0] > 0.5:
            phi.append(2 * e[1:])
            slope.append((e[0] * np.eye(3) - skew(e[1:])) @ W)
        else:
            u = rotation_vector(e)
            phi.append(u)
            slope.append(rotation_vector_slope(u) @ W)
    if not phi:
        n = closure.dp.shape[2]
        return np.zeros(0), np.zeros((0, n))
    return np.concatenate(phi), np.concatenate(slope)


def constrained(equations: Equations, q: Array) -> tuple[Array, Array]:
    """Give phi [6 nr] and its derivative [6 nr, n] at a pose, by the routine for it where that is regular."""
    found = equations.constraint(q)
    return constraint(equations.closure(q)) if found is None else found


def close(equations: Equations, part: Partition, guess: Array, iterations: int = _ITERATIONS) -> Position:
    """Close the cuts by the dependent coordinates.

    Args:
        equations: of the chain.
        part: its coordinates and rows.
        guess: [n]; the independent coordinates stay.
        iterations: at most.
    """
    q, best, since = guess.copy(), np.inf, 0
    steps: list[float] = []
    units = part.units[part.w]
    for count in range(iterations):
        phi, slope = constrained(equations, q)
        rows, A = part.binding(phi), part.dependent(slope)
        residual = float(np.max(np.abs(rows), initial=0.0))
        factored, step = _step(A, rows)
        size = float(np.max(np.abs(step), initial=0.0))
        if residual <= RESIDUAL * _size(q, part) and size <= STEP:
            q[part.w] += step * units
            return _position(q, phi, slope, part, factored, count + 1, steps, guess)
        best, since = (residual, 0) if residual < 0.9 * best else (best, since + 1)
        if since > _STALLED or not np.isfinite(residual):
            break
        steps.append(size)
        q[part.w] += step * units * min(1.0, LARGEST_STEP / size if size else 1.0)
    phi, slope = constrained(equations, q)
    return _position(q, phi, slope, part, None, len(steps), steps, guess, is_solution=False)


def _size(q: Array, part: Partition) -> float:
    """Angles and positions are known to rounding of their size."""
    return float(np.max(np.abs(q / part.units), initial=part.reach))


def _step(A: Array, rows: Array) -> tuple[Factor | None, Array]:
    """The Newton step; where the rank is lost, the smallest of those that reduce the residual most."""
    try:
        found = factor(A)
    except RankLoss:
        return None, np.asarray(scipy.linalg.lstsq(A, -rows, cond=1e-8)[0])
    return found, found.solve(-rows)


def _position(
    q: Array,
    phi: Array,
    slope: Array,
    part: Partition,
    factored: Factor | None,
    iterations: int,
    steps: list[float],
    guess: Array,
    is_solution: bool = True,
) -> Position:
    sizes = np.abs(phi / part.row_units)
    row = int(np.argmax(sizes)) if len(sizes) else 0
    residual = float(np.max(sizes, initial=0.0))
    is_closed = is_solution and residual <= 10 * RESIDUAL * _size(q, part)
    contraction = steps[1] / steps[0] if len(steps) > 1 and steps[0] > 0 else 0.0
    correction = float(np.max(np.abs((q - guess) / part.units), initial=0.0))
    return Position(q, residual, row, is_closed, slope, factored, iterations, contraction, correction)


def nearest(equations: Equations, part: Partition, guess: Array) -> Position:
    """Give the pose near a guess at which the cuts are least open, where they cannot be closed.

    Args:
        equations: of the chain.
        part: its coordinates and rows.
        guess: [n]; the independent coordinates stay.
    """
    q, units = guess.copy(), part.units[part.w]

    def placed(x: Array) -> Array:
        q[part.w] = x * units
        return q

    def rows(x: Array) -> Array:
        return part.binding(constrained(equations, placed(x))[0])

    def slope(x: Array) -> Array:
        return part.dependent(constrained(equations, placed(x))[1])

    tight = {"xtol": 1e-15, "ftol": 1e-15, "gtol": 1e-15, "max_nfev": 500}
    found = scipy.optimize.least_squares(rows, guess[part.w] / units, slope, **tight)
    phi, last = constrained(equations, placed(found.x))
    return _position(q, phi, last, part, None, int(found.nfev), [], guess, is_solution=False)
