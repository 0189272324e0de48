"""Why a run stopped, in words."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from codegen.chains.factor import RankLoss
from codegen.chains.mechanism import Mechanism
from codegen.chains.path import PathEnd
from codegen.chains.position import Position
from codegen.chains.reduced import NoInertia

Array = NDArray[np.float64]

_SHARE = 0.1
"""A coordinate takes part in a direction of length 1 where its share is larger."""


def residual_words(mechanism: Mechanism, found: Position) -> str:
    """Tell the nearest pose and what is left open there."""
    unit = "m" if found.row % 6 < 3 else "rad"
    size = found.residual * mechanism.part.row_units[found.row]
    return (
        f"no solution; the nearest pose leaves {mechanism.row_name(found.row)}, open by {size:.6g} {unit}: "
        f"{mechanism.pose(found.q)}"
    )


def free_words(mechanism: Mechanism, loss: RankLoss) -> str:
    """Tell what is free to move where the Jacobian lacks rank."""
    names = [mechanism.chain.links[k].name for k in mechanism.part.w]
    free = [name for name, share in zip(names, np.abs(loss.free), strict=True) if share > _SHARE]
    return (
        f"rank {loss.rank} of {loss.wanted} dependent coordinates (smallest singular value {loss.least:.1e} of the "
        f"largest); free to move besides: {', '.join(free)}"
    )


def short_words(mechanism: Mechanism, q: Array, least: float) -> str:
    """Tell a pose near which the steps of an integrator lead nowhere."""
    return (
        f"steps become too short near a singular pose (smallest singular value {least:.1e} of the largest): "
        f"{mechanism.pose(q)}"
    )


def inertia_words(mechanism: Mechanism, lack: NoInertia) -> str:
    """Tell which independent coordinates move no mass."""
    names = [mechanism.chain.links[k].name for k in mechanism.part.v]
    shares = np.abs(lack.free) / np.max(np.abs(lack.free))
    free = [name for name, share in zip(names, shares, strict=True) if share > _SHARE]
    return f"no mass resists the acceleration of {', '.join(free)}"


def path_words(mechanism: Mechanism, end: PathEnd) -> str:
    """Tell where a path ended and what lies beyond."""
    last = mechanism.pose(end.reached.q)
    if end.is_singular:
        return f"bifurcation: branches of the motion meet at the pose {last}"
    return f"{residual_words(mechanism, end.beyond)}; last closed pose: {last}"
