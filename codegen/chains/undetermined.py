"""Reactions that the equations of a rigid chain leave open: of dependent rows, and of rows that no coordinate moves."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from codegen.chains.generated import Generated
from codegen.chains.mechanism import AXES, Mechanism
from codegen.chains.reduced import rates
from codegen.chains.state import State

Array = NDArray[np.float64]

_SHARE = 1e-7
"""A component that changes by less than this part of a unit reaction does not depend on it."""


def undetermined(mechanism: Mechanism, equations: Generated, state: State) -> tuple[str, ...]:
    """Name the components of cut reactions and joint wrenches that are one choice among many.

    Reactions that move no coordinate may be added to those of the cuts; what changes with them, there and in joints,
    is not determined. In the run it is the smallest possible in binding rows and 0 in the others.

    Args:
        mechanism: the chain.
        equations: of the chain.
        state: at which rank and structure are looked at.
    """
    chain = mechanism.chain
    none, still = np.zeros(len(chain.links)), np.zeros(6 * len(chain.effectors))
    free = _free(mechanism, state)
    plain = equations.wrenches(state.q, none, none, np.zeros(len(free)), still)
    size = max(1.0, float(np.max(np.abs(plain), initial=0.0)))
    cuts, joints = np.zeros(len(free)), np.zeros_like(plain)
    for reaction in free.T:
        cuts = np.maximum(cuts, np.abs(reaction))
        changed = equations.wrenches(state.q, none, none, reaction * size, still) - plain
        joints = np.maximum(joints, np.abs(changed) / size)
    names = [f"cut.{chain.cuts[row // 6].name}.{AXES[row % 6]}" for row in np.flatnonzero(cuts > _SHARE)]
    return (*names, *(f"{chain.links[k].name}.{AXES[i]}" for k, i in np.argwhere(joints > _SHARE)))


def _free(mechanism: Mechanism, state: State) -> Array:
    """Reactions that move no coordinate [6 nr, k], of unit length without dimension."""
    part = mechanism.part
    rows = len(part.row_units)
    found = rates(mechanism.equations, part, state.q, np.zeros(len(part.v)))
    of_binding = found.factor.undetermined() / part.row_units[part.rows, None]
    loose = [row for row in range(rows) if row not in part.rows]
    free = np.zeros((rows, of_binding.shape[1] + len(loose)))
    free[part.rows, : of_binding.shape[1]] = of_binding
    free[loose, of_binding.shape[1] + np.arange(len(loose))] = 1.0
    return free
