"""Follow the dependent coordinates along a path of the independent ones, on one branch.

From a closed pose the target is reached along a straight line of q_v: tangent predictor, Newton corrector. A piece is
accepted if Newton contracts well from its prediction and if the Jacobian keeps its orientation, the sign of the
determinant that changes from one branch to another; else the piece is halved. A path that cannot be followed with
pieces of any length ends at a singular pose, where branches meet, or where the cuts cannot be closed any more.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from codegen.chains.equations import Equations
from codegen.chains.factor import Factor, RankLoss, Square, factor
from codegen.chains.newton import CONTRACTION, CORRECTED, ITERATIONS, PREDICTED, TINY
from codegen.chains.partition import Partition
from codegen.chains.position import Position, close, nearest

Array = NDArray[np.float64]

_SHORTEST = 1e-9
"""rad, or characteristic lengths: the shortest piece of the path of q_v."""

_PAST = 1e-5
"""rad, or characteristic lengths: so far beyond its end a path is looked at first."""

_PLACES = (0.25, 0.5, 0.75, 1.0)
"""Then at these parts of the rest of the way."""

CLOSED = 1e-9
"""rad, or characteristic lengths: cuts that are less open can be closed."""


class PathEnd(Exception):
    """A path cannot be followed further.

    Attributes:
        reached: the last closed pose.
    """

    def __init__(self, reached: Branch, look: Callable[[], Position]) -> None:
        super().__init__()
        self.reached, self._look = reached, look

    @cached_property
    def beyond(self) -> Position:
        """Where the cuts are most open between there and the target, at the pose that opens them least."""
        return self._look()

    @property
    def is_singular(self) -> bool:
        """Whether branches meet at the last pose: cuts can be closed beyond it, but not on the branch so far."""
        return self.beyond.residual < CLOSED


@dataclass(frozen=True, slots=True, eq=False)
class Branch:
    """A closed pose on a branch.

    Attributes:
        q: [n].
        factor: of the dependent columns of the derivative of phi, without dimension.
        slope: [nw, nv] d q_w / d q_v, without dimension.
        orientation: 1 or -1, kept along the branch.
        iterations: of Newton, since the branch was entered.
    """

    q: Array
    factor: Factor
    slope: Array
    orientation: float
    iterations: int = 0


def branch(part: Partition, position: Position, before: Branch | None = None) -> Branch:
    """Enter a branch at a closed pose, or go on along one.

    Raises:
        RankLoss: the pose is singular.
    """
    found = position.factor or factor(part.dependent(position.slope))
    B = part.binding(position.slope[:, part.v] * part.units[part.v])
    orientation = 1.0 if before is None else before.orientation * _turn(before.factor, found)
    done = position.iterations + (before.iterations if before else 0)
    return Branch(position.q, found, -found.solve(B), orientation, done)


def _turn(before: Factor, now: Factor) -> float:
    """1 if a Jacobian has the orientation of the one before, else -1."""
    if not now.A.shape[1]:
        return 1.0
    if isinstance(before, Square) and isinstance(now, Square):
        return before.sign * now.sign
    return float(np.sign(np.linalg.det(before.solve(now.A))))


def follow(equations: Equations, part: Partition, start: Branch, q_v: Array) -> Branch:
    """Go on to a target.

    Args:
        equations: of the chain.
        part: its coordinates and rows.
        start: a closed pose.
        q_v: the target.

    Raises:
        PathEnd: it cannot be reached on this branch.
    """
    units_v, units_w = part.units[part.v], part.units[part.w]
    here = start
    origin = start.q[part.v]
    whole = (q_v - origin) / units_v
    size = float(np.max(np.abs(whole), initial=0.0))
    done, piece = 0.0, 1.0
    while done < 1.0:
        piece = min(piece, 1.0 - done)
        rate = float(np.max(np.abs(here.slope @ whole), initial=0.0))
        piece = min(piece, PREDICTED / rate if rate > 0 else 1.0)
        guess = here.q.copy()
        guess[part.v] = q_v if done + piece >= 1.0 else origin + (done + piece) * whole * units_v
        guess[part.w] += piece * (here.slope @ whole) * units_w
        there = _tried(equations, part, here, guess)
        if there is not None:
            done, here, piece = done + piece, there, 2 * piece
            continue
        piece /= 2
        if piece * size < _SHORTEST:
            raise PathEnd(here, partial(_beyond, equations, part, here, q_v))
    return here


def _beyond(equations: Equations, part: Partition, here: Branch, q_v: Array) -> Position:
    """The nearest pose at the worst of a few places between the end of a path and its target."""
    rest = q_v - here.q[part.v]
    size = float(np.max(np.abs(rest / part.units[part.v])))
    found, guess = [], here.q.copy()
    for share in (min(1.0, _PAST / size) if size else 1.0, *_PLACES):
        guess[part.v] = here.q[part.v] + share * rest
        found.append(nearest(equations, part, guess))
        guess = found[-1].q.copy()
    return max(found, key=lambda position: position.residual)


def _tried(equations: Equations, part: Partition, here: Branch, guess: Array) -> Branch | None:
    """The same branch at a guess; None if it is not found there."""
    found = close(equations, part, guess, ITERATIONS)
    if not found.is_closed:
        return None
    if found.correction > TINY and (found.contraction > CONTRACTION or found.correction > CORRECTED):
        return None
    try:
        there = branch(part, found, here)
    except RankLoss:
        return None
    return there if there.orientation == here.orientation else None
