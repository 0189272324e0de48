"""Forces on a chain, as data: on its coordinates and at its end effectors, some only while a condition holds."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from codegen.spec.scene import Limit, Vector


@dataclass(frozen=True, slots=True)
class Condition:
    """When a switched force acts: while ``lower <= q <= upper`` and q moves in the direction.

    Attributes:
        joint: name of the link whose coordinate q is.
        lower: m or rad; None for no bound.
        upper: m or rad; None for no bound.
        direction: 1 while q grows, -1 while it falls, 0 always.
    """

    joint: str
    lower: Fraction | None
    upper: Fraction | None
    direction: int


@dataclass(frozen=True, slots=True)
class JointForce:
    """``constant - stiffness (q - rest) - damping qd`` on a joint coordinate.

    Attributes:
        joint: name of the link.
        constant: N or N m.
        stiffness: N/m or N m/rad.
        damping: N s/m or N m s/rad.
        rest: m or rad.
        when: None for always.
    """

    joint: str
    constant: Fraction = Fraction(0)
    stiffness: Fraction = Fraction(0)
    damping: Fraction = Fraction(0)
    rest: Fraction = Fraction(0)
    when: Condition | None = None


@dataclass(frozen=True, slots=True)
class EffectorForce:
    """A constant wrench on the chain at an effector, besides the effector's own.

    Attributes:
        effector: its name.
        force: [3] N, axes of the effector.
        moment: [3] N m about its origin, likewise.
        when: None for always.
    """

    effector: str
    force: Vector
    moment: Vector
    when: Condition | None = None


@dataclass(frozen=True, slots=True)
class WorldForce:
    """A constant wrench on the chain at an effector, in axes that do not turn with it.

    Attributes:
        effector: its name.
        force: [3] N, axes of frame 0; of the world where the base moves.
        moment: [3] N m about the effector's origin, likewise.
        when: None for always.
    """

    effector: str
    force: Vector
    moment: Vector
    when: Condition | None = None


@dataclass(frozen=True, slots=True)
class Spring:
    """A spring and damper between the origins of two effectors; its tension is ``k (l - l0) + c ldot``.

    Attributes:
        effectors: their names.
        stiffness: ``k``, N/m.
        damping: ``c``, N s/m.
        length: ``l0``, m, at which it is free.
    """

    effectors: tuple[str, str]
    stiffness: Fraction
    damping: Fraction
    length: Fraction


@dataclass(frozen=True, slots=True)
class Stop:
    """Soft stops of a joint coordinate.

    Attributes:
        joint: name of the link.
        limit: where they stand, and their spring and damper.
    """

    joint: str
    limit: Limit
