"""Motions of the independent coordinates of a chain, as data; numbers are exact, in m, rad and s."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction


@dataclass(frozen=True, slots=True)
class Polynomial:
    """``sum of coefficients[k] t^k``, m or rad; one coefficient is a constant."""

    coefficients: tuple[Fraction, ...]


@dataclass(frozen=True, slots=True)
class Harmonic:
    """``mean + speed t + amplitude sin(frequency t + phase)``, m or rad; speed in m/s or rad/s, frequency in rad/s."""

    mean: Fraction
    amplitude: Fraction
    frequency: Fraction
    phase: Fraction
    speed: Fraction = Fraction(0)


@dataclass(frozen=True, slots=True)
class Table:
    """Values in a CSV file of two columns, t in s and the coordinate; its path is from the folder of the chain file."""

    file: str


Motion = Polynomial | Harmonic | Table


@dataclass(frozen=True, slots=True)
class Independent:
    """An independent coordinate.

    Attributes:
        joint: name of the link whose inner joint it is.
        motion: for kinematics and inverse dynamics; None where none is given.
        position: m or rad at t = 0, for forward dynamics; None for the motion's, or the row's without a motion.
        speed: m/s or rad/s at t = 0; None for the motion's, or 0 without a motion.
        driven: whether the motion is prescribed in forward dynamics too; there is one then.
    """

    joint: str
    motion: Motion | None = None
    position: Fraction | None = None
    speed: Fraction | None = None
    driven: bool = False
