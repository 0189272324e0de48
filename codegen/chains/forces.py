"""Forces of a chain that switch: on coordinates and at effectors, while their conditions hold.

What acts at all times is in the routines of the chain, as ``tau_A`` and ``f_A``.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from codegen.spec.chain import Chain
from codegen.spec.chain_forces import Condition, EffectorForce, JointForce

Array = NDArray[np.float64]


class Forces:
    """The switched forces of a chain, in numbers.

    Attributes:
        conditions: of the forces, those on joints first; a force is told by its place here.
    """

    def __init__(self, chain: Chain) -> None:
        self._joints = {link.name: k for k, link in enumerate(chain.links)}
        self._effectors = {effector.name: k for k, effector in enumerate(chain.effectors)}
        self._size = len(chain.links)
        forces: list[JointForce | EffectorForce] = [*chain.joint_forces, *chain.effector_forces]
        self._switched = [force for force in forces if force.when is not None]
        self.conditions: tuple[Condition, ...] = tuple(force.when for force in self._switched if force.when is not None)

    def coordinate(self, condition: Condition) -> int:
        """Number of the coordinate that a condition asks."""
        return self._joints[condition.joint]

    def active(self, q: Array, qd: Array) -> tuple[bool, ...]:
        """Say of each condition whether it holds."""
        return tuple(_holds(one, q[self.coordinate(one)], qd[self.coordinate(one)]) for one in self.conditions)

    def on_joints(self, q: Array, qd: Array, active: Sequence[bool]) -> Array:
        """Give the forces along the coordinates [n]."""
        found = np.zeros(self._size)
        for force in self._acting(active):
            if isinstance(force, JointForce):
                k = self._joints[force.joint]
                found[k] += float(force.constant) - float(force.damping) * qd[k]
                found[k] -= float(force.stiffness) * (q[k] - float(force.rest))
        return found

    def at_effectors(self, active: Sequence[bool]) -> Array:
        """Give the wrenches at the effectors [ne, 6], their axes."""
        found = np.zeros((len(self._effectors), 6))
        for force in self._acting(active):
            if isinstance(force, EffectorForce):
                found[self._effectors[force.effector]] += np.array([*force.force, *force.moment], dtype=np.float64)
        return found

    def _acting(self, active: Sequence[bool]) -> list[JointForce | EffectorForce]:
        return [force for force, holds in zip(self._switched, active, strict=True) if holds]


def _holds(condition: Condition, q: float, qd: float) -> bool:
    is_above = condition.lower is None or q >= float(condition.lower)
    is_below = condition.upper is None or q <= float(condition.upper)
    return is_above and is_below and (condition.direction == 0 or condition.direction * qd > 0)
