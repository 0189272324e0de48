"""Other independent coordinates where one of them turns back while the chain moves on.

There the dependent coordinates move without bound beside it. The one that moves most takes its place: of all single
exchanges that takes the Jacobian of the dependent ones furthest from a singular one.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from codegen.chains.mechanism import Mechanism, parted
from codegen.chains.path import Branch, branch
from codegen.chains.position import close

Array = NDArray[np.float64]

_GROWTH = 10.0
"""So much steeper than at first, and than 1, a dependent coordinate has to become."""


def steepest(slope: Array, is_driven: NDArray[np.bool_]) -> float:
    """Fastest dependent coordinate beside a free one.

    Args:
        slope: [nw, nv] d q_w / d q_v, without dimension.
        is_driven: [nv] independent coordinates that are not free.
    """
    return float(np.max(np.abs(slope[:, ~is_driven]), initial=0.0))


def bound(slope: Array, is_driven: NDArray[np.bool_]) -> float:
    """How steep a slope may become from here on, as `steepest` has it; gears keep theirs."""
    return _GROWTH * max(1.0, steepest(slope, is_driven))


def exchanged(
    mechanism: Mechanism, here: Branch, is_driven: NDArray[np.bool_], allowed: float
) -> tuple[Mechanism, Branch]:
    """The same chain, where it is, by independent coordinates beside which none is steeper than allowed.

    Args:
        mechanism: the chain.
        here: its pose.
        is_driven: [nv] independent coordinates that keep their places.
        allowed: slope, as `steepest` has it.

    Raises:
        RankLoss: the pose is singular.
    """
    while steepest(here.slope, is_driven) > allowed:
        mechanism = _exchanged(mechanism, here.slope, is_driven)
        there = branch(mechanism.part, close(mechanism.equations, mechanism.part, here.q))
        here = replace(there, iterations=here.iterations + there.iterations)
    return mechanism, here


def _exchanged(mechanism: Mechanism, slope: Array, is_driven: NDArray[np.bool_]) -> Mechanism:
    """With the steepest dependent coordinate in the place of the free one beside which it is."""
    part = mechanism.part
    found = np.where(is_driven, 0.0, np.abs(slope))
    row, column = np.unravel_index(int(np.argmax(found)), found.shape)
    independent = part.v.tolist()
    independent[column] = int(part.w[row])
    return parted(mechanism.chain, mechanism.equations, independent)
