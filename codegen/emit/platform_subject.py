"""A six-legged platform as the subject of routines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from codegen.emit.routine import Member, Preparation, Words
from codegen.errors import InternalError
from codegen.ir.looped import Looped
from codegen.ir.program import Argument, Program, Result
from codegen.spec.platform import LEGS, Platform

BLOCKS = ("sigma", "beta", "alpha", "gamma")

OUTPUTS: dict[str, tuple[str, str, str]] = {
    "lengths": ("Lengths of the legs", "legs", "m"),
    "J": ("Jacobian J of ldot = J (v, w): rows (e_i, p_i x e_i)", "legs x (v, w), base axes", "1, m"),
    "D": ("Products of the values of the four blocks; a large one is slow and stiff", "blocks", "1, 1, m^3, m^3"),
    "C": ("Condition numbers of the four blocks; infinite in singular poses", "blocks", "1"),
    "values": ("Values of the four blocks, descending: sigma, beta, alpha, gamma", "blocks", "1, m"),
    "semi_axes": ("Semi-axes of the four ellipsoids, ascending: 1 / values", "blocks", "1, 1/m"),
    "ellipsoids": ("Factors F of the four ellipsoids {F u: |u| <= 1}", "base axes; 3 columns a block", "1, 1/m"),
    "Q1": ("Q1 with v = Q1' ldot", "legs x v, base axes", "1"),
    "Q2": ("Q2 with w = Q2' ldot", "legs x w, base axes", "1/m"),
    "w_of_v": ("Accompanying rotation: w = w_of_v v where v is extremal", "base axes", "1/m"),
    "v_of_w": ("Accompanying translation: v = v_of_w w where w is extremal", "base axes", "m"),
    "det": ("|det J|, the product of D of sigma and gamma", "scalar", "m^3"),
    "limits": ("Greatest components of v and w if no leg is faster than 1 m/s", "v, w, base axes", "1, 1/m"),
    "dD": ("Gradients of D by pose and joints", "blocks x directions", "1/m, 1/rad, m^2, m^3/rad"),
    "dC": ("Gradients of C by pose and joints, vectors held fixed", "blocks x directions", "1/m, 1/rad"),
    "status": ("Sum of 1, 2, 4 (J1, J2, J lack rank) and 8 (no number), stored as a number", "scalar", "1"),
    "all": ("All quantities at once, sub-expressions shared", "", ""),
}
"""Quantity -> what it is, its axes, its unit."""

_OF_BLOCKS = {"D": 1, "C": 1, "values": 3, "semi_axes": 3}

_MEANINGS = {
    "sigma": "v for all leg speeds of norm 1: N_v",
    "beta": "v without rotation: J1' J1",
    "alpha": "w for all leg speeds of norm 1: N_w",
    "gamma": "w without translation: J2' J2",
}


@dataclass(frozen=True)
class PlatformSubject:
    """A platform, and how its quantities are evaluated."""

    platform: Platform

    @property
    def stem(self) -> str:
        """Start of the symbols."""
        return f"jg_{self.platform.name}"

    def routine_stem(self, output: str) -> str:
        """The symbol of a routine without its storage ending."""
        return f"{self.stem}_{output}"

    def part(self, kind: int) -> PlatformSubject:
        """There are no loops in a platform."""
        raise InternalError("a platform has no instances")

    def argument(self, argument: Argument) -> Words:
        """Axes, unit and parts of an argument."""
        order = self.platform.wanted.attitude
        axes = "platform, one after the other" if order.isupper() else "base"
        words = {
            "o": ("origin of the platform, base axes", "m"),
            "R": ("platform to base, taken as a rotation", "1"),
            "q": ("platform to base, w x y z of any length", "1"),
            "angles": (f"Euler angles {order}, about axes of the {axes}", "rad"),
            "base": ("joints on the base, base axes", "m"),
            "platform": ("joints on the platform, platform axes", "m"),
        }
        frame, unit = words[argument.name]
        return Words(frame, unit)

    def output(self, output: Result) -> Words:
        """Axes, unit and parts of an output."""
        _, frame, unit = OUTPUTS.get(output.name, ("", "partial derivatives by the entries of an argument", "mixed"))
        return Words(frame, unit, tuple(self._members(output.name)))

    def brief(self, output: str) -> str:
        """What a routine does, in a line."""
        return f"{OUTPUTS[output][0]}: platform {self.platform.name}."

    def details(self, output: str, program: Program | Looped, preparation: Preparation | None) -> Sequence[str]:
        """What a user must know besides, sentence by sentence."""
        return [
            f"Variant {self.platform.wanted.variant}.",
            "v is the velocity of the origin of the platform, w its angular velocity, both in base axes.",
        ]

    def record(self) -> dict[str, Any]:
        """What the manifest says of the platform."""
        wanted = self.platform.wanted
        return {"platform": self.platform.name, "variant": wanted.variant, "attitude": wanted.attitude}

    def _members(self, name: str) -> list[Member]:
        if name in _OF_BLOCKS:
            size = _OF_BLOCKS[name]
            return [(f"{name}_{block}", size * k, (size, 1), _MEANINGS[block]) for k, block in enumerate(BLOCKS)]
        if name == "limits":
            return [("limits_v", 0, (3, 1), "components of v"), ("limits_w", 3, (3, 1), "components of w")]
        return []


def platform_record(platform: Platform) -> dict[str, Any]:
    """What the manifest says of a platform as a whole; lengths in m."""
    return {
        "name": platform.name,
        "legs": LEGS,
        "variant": platform.wanted.variant,
        "attitude": platform.wanted.attitude,
        "base": [[float(x) for x in point] for point in platform.base],
        "joints": [[float(x) for x in point] for point in platform.joints],
        "home": {
            "o": [float(x) for x in platform.home.position],
            "R": [[float(x) for x in row] for row in platform.home.rotation],
        },
    }
