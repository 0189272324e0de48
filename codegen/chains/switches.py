"""Events of switched forces: a coordinate that crosses a bound of a condition, or that turns round."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from codegen.spec.chain_forces import Condition


@dataclass(frozen=True, slots=True)
class Switch:
    """One reason for which a condition holds or not.

    Attributes:
        condition: number of the condition.
        coordinate: that it asks.
        bound: of the coordinate; None for the speed.
        sign: the switch is on while ``sign (coordinate - bound)``, or ``sign * speed``, is positive.
    """

    condition: int
    coordinate: int
    bound: float | None
    sign: int

    def value(self, q: float, qd: float) -> float:
        """What changes sign: positive while the switch is on."""
        return self.sign * (qd if self.bound is None else q - self.bound)

    def rate(self, qd: float, qdd: float) -> float:
        """Its rate."""
        return self.sign * (qdd if self.bound is None else qd)


def switches(conditions: tuple[Condition, ...], coordinates: list[int]) -> tuple[Switch, ...]:
    """Give the switches of all conditions.

    Args:
        conditions: of the forces.
        coordinates: the number of the coordinate that each asks.
    """
    return tuple(switch for k, condition in enumerate(conditions) for switch in _switches(k, condition, coordinates[k]))


def _switches(number: int, condition: Condition, coordinate: int) -> Iterator[Switch]:
    if condition.lower is not None:
        yield Switch(number, coordinate, float(condition.lower), 1)
    if condition.upper is not None:
        yield Switch(number, coordinate, float(condition.upper), -1)
    if condition.direction:
        yield Switch(number, coordinate, None, condition.direction)


def active(found: tuple[Switch, ...], is_on: tuple[bool, ...], conditions: int) -> tuple[bool, ...]:
    """Say of each condition whether it holds: all of its switches are on."""
    off = {switch.condition for switch, on in zip(found, is_on, strict=True) if not on}
    return tuple(k not in off for k in range(conditions))
