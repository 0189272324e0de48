"""When the forces of a chain that switch act."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from codegen.spec.chain import Chain
from codegen.spec.chain_forces import Condition

Array = NDArray[np.float64]


class Conditions:
    """The conditions of a chain, in numbers.

    Attributes:
        conditions: of its forces, in the order of `codegen.spec.chain.Chain.conditions`.
        coordinates: number of the coordinate that each asks.
    """

    def __init__(self, chain: Chain) -> None:
        self.conditions = chain.conditions
        self.coordinates = [chain.index(one.joint) for one in self.conditions]

    def active(self, q: Array, qd: Array) -> tuple[bool, ...]:
        """Say of each condition whether it holds."""
        return tuple(_holds(one, q[k], qd[k]) for one, k in zip(self.conditions, self.coordinates, strict=True))


def _holds(condition: Condition, q: float, qd: float) -> bool:
    is_above = condition.lower is None or q >= float(condition.lower)
    is_below = condition.upper is None or q <= float(condition.upper)
    return is_above and is_below and (condition.direction == 0 or condition.direction * qd > 0)
