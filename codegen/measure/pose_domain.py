"""Where accuracy is judged: a box of poses of one joint, and the scale of each block of outputs in it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from codegen.ir.program import Output
from codegen.measure.constraints import Row

LEAST_PITCH, LARGEST_PITCH = 0.05, 0.3
"""Of screw joints, m/rad."""
LARGEST_START, MOST_TURNS = 1.0, 2
"""Of their initial angle, rad, and of their revolutions."""


@dataclass(frozen=True, slots=True)
class PoseDomain:
    """Bounds on the inputs of a joint's routines; the default is the standard domain.

    Attributes:
        r: of each component of the position of body i, m.
        s: of the length of the attachment points, m.
        d: of each translation of the joint, m.
        angle: of each angle of the joint, rad.
        pitch_angle: of the middle angle of rot3, rad; its gimbal lock is at pi/2.
        misfit: of what a pose in mid-iteration is off the constraint: m, and rad.
        velocity: of each entry of the velocity.
        multiplier: of each entry of lambda.
        drift: of each entry of ``A_i`` and ``A_j`` from the rotation, relative to 1.
        distance: of both bodies from the origin, m.
    """

    r: float = 1.0
    s: float = 1.0
    d: float = 1.0
    angle: float = math.pi
    pitch_angle: float = 1.2
    misfit: float = 0.1
    velocity: float = 1.0
    multiplier: float = 1.0
    drift: float = 0.0
    distance: float = 0.0

    @property
    def length(self) -> float:
        """The scale of lengths: of the joint, not of its place in the world."""
        return max(self.s, self.d)

    def scale(self, output: str, is_rotation: bool = False) -> float:
        """Give the natural scale of a block.

        Args:
            output: a quantity or a product.
            is_rotation: of ``phi``: whether its rows have no unit.
        """
        arm = max(1.0, self.length)
        return {
            "phi": 1.0 if is_rotation else self.length,
            "phi_q": arm,
            "phi_q_t_lambda_q": self.multiplier * arm,
            "gamma": self.velocity**2 * arm,
            "phi_q_v": self.velocity * arm,
            "phi_q_t_lambda": self.multiplier * arm,
        }[output]


@dataclass(frozen=True, slots=True)
class Block:
    """Entries of an output that are judged together.

    Attributes:
        name: for readers: ``phi translation``, ``phi rotation``, or the output.
        output: a quantity or a product.
        entries: places among its nonzeros.
    """

    name: str
    output: str
    entries: tuple[int, ...]

    @property
    def is_rotation(self) -> bool:
        """Whether these are rows of ``phi`` without unit."""
        return self.name == "phi rotation"


def blocks(output: Output, rows: tuple[Row, ...]) -> tuple[Block, ...]:
    """Split an output into blocks: ``phi`` by the units of its rows, every other output is one."""
    if output.name != "phi":
        return (Block(output.name, output.name, tuple(range(len(output.values)))),) if output.values else ()
    names = {"m": "phi translation", "1": "phi rotation"}
    found = {
        unit: tuple(k for k, (row, _) in enumerate(output.sparsity.entries()) if rows[row].unit == unit)
        for unit in names
    }
    return tuple(Block(names[unit], "phi", entries) for unit, entries in found.items() if entries)
