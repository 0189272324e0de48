"""The pose at t = 0: cuts closed, on the branch that the file prefers, with a Jacobian of full rank."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from codegen.chains.factor import RANK_TOLERANCE, RankLoss
from codegen.chains.mechanism import ROWS, Mechanism, parted
from codegen.chains.path import Branch, PathEnd, branch, follow
from codegen.chains.position import Position, close, constraint, nearest
from codegen.chains.stop import free_words, path_words, residual_words
from codegen.errors import Mistake, SpecificationError

Array = NDArray[np.float64]

CLOSED = 1e-6
"""rad, or characteristic lengths: a cut that is less open with the coordinates of the file is closed without a word.
It is closed by moving coordinates; what no coordinate closes is told however small it is."""

_CAN_CLOSE = 1e-9
"""rad, or characteristic lengths: less is left open where the cuts can be closed."""


def start(mechanism: Mechanism, q_v: Array) -> Branch:
    """Close a chain at its start.

    The cuts are closed with the independent coordinates as the file has them; then those go to the start of the motion,
    on the branch that was found.

    Args:
        mechanism: the chain.
        q_v: independent coordinates at the start of the motion.

    Raises:
        SpecificationError: cuts are open or cannot be closed, rows that no coordinate moves are open, the pose is
            singular, or the start of the motion cannot be reached.
    """
    equations, part = mechanism.equations, mechanism.part
    guess = coordinates(mechanism)
    mistakes = [*_gaps(mechanism), *_stuck(mechanism, guess)]
    if mistakes:
        raise SpecificationError(mistakes)
    found = close(equations, part, guess)
    if not found.is_closed:
        raise SpecificationError([_not_closed(mechanism, nearest(equations, part, guess))])
    try:
        return follow(equations, part, branch(part, found), q_v)
    except RankLoss as loss:
        what = f"the pose at t = 0 is singular: {free_words(mechanism, loss)}"
        raise SpecificationError([Mistake("independent", what, "choose other independent coordinates")]) from loss
    except PathEnd as end:
        what = f"the start of the motion cannot be reached: {path_words(mechanism, end)}"
        raise SpecificationError([Mistake("independent", what, "start the motion near the pose of the rows")]) from end


def coordinates(mechanism: Mechanism) -> Array:
    """The coordinates from which the cuts are closed: as the rows have them, or as preferred."""
    chosen = [
        link.prefer if link.prefer is not None and k in mechanism.part.w else link.coordinate
        for k, link in enumerate(mechanism.chain.links)
    ]
    return np.array(chosen, dtype=np.float64)


def _gaps(mechanism: Mechanism) -> Iterator[Mistake]:
    """Cuts that are open with the coordinates of the file, where these are not said to be guesses."""
    chain = mechanism.chain
    if chain.assemble or any(link.prefer is not None for link in chain.links):
        return
    phi, _ = constraint(mechanism.equations.closure(coordinates(mechanism)))
    for cut, rows in zip(chain.cuts, phi.reshape(-1, 6), strict=True):
        apart, turned = float(np.linalg.norm(rows[:3])), float(np.linalg.norm(rows[3:]))
        if apart > CLOSED * mechanism.length or turned > CLOSED:
            what = f"is open by {apart:.6g} m and {math.degrees(turned):.6g} degrees at t = 0"
            remedy = "correct theta, d and the constants, or accept guesses with assemble = true"
            yield Mistake(f'cut "{cut.name}"', what, remedy)


def _stuck(mechanism: Mechanism, q: Array) -> Iterator[Mistake]:
    """Rows that are open and that no coordinate moves."""
    phi, _ = constraint(mechanism.equations.closure(q))
    for row in np.flatnonzero(~np.array(mechanism.equations.binding, dtype=bool)):
        if abs(phi[row]) > 1e-12 * mechanism.part.row_units[row]:
            unit = "m" if row % 6 < 3 else "rad"
            what = f"{ROWS[row % 6]} is open by {abs(phi[row]):.6g} {unit}, and no coordinate moves it"
            yield Mistake(f'cut "{mechanism.chain.cuts[row // 6].name}"', what, "correct the constants of the links")


def _not_closed(mechanism: Mechanism, found: Position) -> Mistake:
    """Tell it; the independent coordinates may be to blame, where the cuts close with them free."""
    loose = parted(mechanism.chain, mechanism.equations, [])
    freed = nearest(mechanism.equations, loose.part, found.q)
    what = f"the cuts cannot be closed at t = 0: {residual_words(mechanism, found)}"
    if freed.residual > _CAN_CLOSE:
        remedy = "correct the constants of the links, or give coordinates near the closed pose"
        return Mistake("cuts", what, remedy)
    free, named = freedom(loose, freed.q), len(mechanism.part.v)
    if named > free:
        remedy = (
            f"name {free} independent coordinates, as many as the cuts leave free where they close, instead of {named}"
        )
        return Mistake("independent", what, f"{remedy}; or correct the constants of the links")
    remedy = f"correct the independent coordinates; with these free too the cuts close at {mechanism.pose(freed.q)}"
    return Mistake("independent", what, remedy)


def freedom(mechanism: Mechanism, q: Array) -> int:
    """How many coordinates the cuts leave free at a closed pose."""
    part = mechanism.part
    J = mechanism.equations.jacobian(q)[part.rows] * part.units / part.row_units[part.rows, None]
    values = np.linalg.svd(J, compute_uv=False)
    return len(part.units) - int((values > RANK_TOLERANCE * values.max(initial=0.0)).sum())
