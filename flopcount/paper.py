"""The printed numbers of S1 (Lee, Lee and Bae, 2013): Tables 1, 2, 5, 7 and 8, and their misprints.

Input: none. Output: literal tables. Nothing here is computed but the rates that can be checked against the
printed ones; what the numbers mean, and how far they can be reproduced, is the matter of `flopcount.rules`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

Derivative = Literal["phi_q", "phi_q_t_lambda_q"]
"""The two quantities that the paper counts: the Jacobian, and d(Jacobian^T lambda)."""

DERIVATIVES: tuple[Derivative, ...] = ("phi_q", "phi_q_t_lambda_q")

JOINTS = ("revolute", "translational", "screw", "cylindrical", "universal", "planar", "ball")
"""The seven joints, in the order of the paper's tables."""

BASIC_CONSTRAINTS = ("dot-1", "dot-2", "spherical", "screw")
"""The four basic constraints of the conventional method, in the order of Table 2."""


@dataclass(frozen=True, slots=True)
class Operations:
    """Numbers of arithmetic operations.

    Attributes:
        phi_q: for the Jacobian.
        phi_q_t_lambda_q: for the second derivative.
    """

    phi_q: int
    phi_q_t_lambda_q: int

    def of(self, derivative: Derivative) -> int:
        """Select one of the two."""
        return self.phi_q if derivative == "phi_q" else self.phi_q_t_lambda_q

    def __add__(self, other: Operations) -> Operations:
        return Operations(self.phi_q + other.phi_q, self.phi_q_t_lambda_q + other.phi_q_t_lambda_q)

    def __mul__(self, times: int) -> Operations:
        return Operations(times * self.phi_q, times * self.phi_q_t_lambda_q)


@dataclass(frozen=True, slots=True)
class Comparison:
    """One line of Table 7.

    Attributes:
        conventional: operations of the conventional method.
        proposed: operations of the parametric method.
        printed_rates: proposed over conventional in percent, as printed (phi_q, second derivative).
    """

    conventional: Operations
    proposed: Operations
    printed_rates: tuple[float, float]

    def rate(self, derivative: Derivative) -> float:
        """Proposed over conventional, in percent, computed from the printed counts."""
        return 100.0 * self.proposed.of(derivative) / self.conventional.of(derivative)


@dataclass(frozen=True, slots=True)
class Timing:
    """One line of Table 8.

    Attributes:
        sets: sets of slider and crank in the model.
        conventional: computation time of the conventional method, s.
        proposed: computation time of the parametric method, s.
    """

    sets: int
    conventional: float
    proposed: float


@dataclass(frozen=True, slots=True)
class Composition:
    """One line of Table 5: the parts of a joint in the parametric method.

    Attributes:
        translation: number of translational coordinates, the k of trn_k.
        rotation: number of rotational coordinates, the m of rot_m.
    """

    translation: int
    rotation: int


@dataclass(frozen=True, slots=True)
class Footnote:
    """A misprint of a table.

    Attributes:
        place: where it stands.
        printed: what is printed.
        correct: what it must be.
        reason: why.
    """

    place: str
    printed: str
    correct: str
    reason: str

    def __str__(self) -> str:
        return f"{self.place}: printed {self.printed}, must be {self.correct}: {self.reason}"


TABLE_1: Mapping[str, Mapping[str, int]] = MappingProxyType(
    {
        "revolute": MappingProxyType({"spherical": 1, "dot-1": 2}),
        "translational": MappingProxyType({"dot-1": 3, "dot-2": 2}),
        "screw": MappingProxyType({"dot-1": 2, "dot-2": 2, "screw": 1}),
        "cylindrical": MappingProxyType({"dot-1": 2, "dot-2": 2}),
        "universal": MappingProxyType({"spherical": 1, "dot-1": 1}),
        "planar": MappingProxyType({"dot-1": 2, "dot-2": 1}),
        "ball": MappingProxyType({"spherical": 1}),
    }
)
"""Table 1: how many of which basic constraint make a joint."""

TABLE_2: Mapping[str, Operations] = MappingProxyType(
    {
        "dot-1": Operations(84, 141),
        "dot-2": Operations(126, 258),
        "spherical": Operations(54, 78),
        "screw": Operations(144, 276),
    }
)
"""Table 2: operations of each basic constraint."""

TABLE_5: Mapping[str, Composition] = MappingProxyType(
    {
        "revolute": Composition(0, 1),
        "translational": Composition(1, 0),
        "screw": Composition(1, 1),
        "cylindrical": Composition(1, 1),
        "universal": Composition(0, 2),
        "planar": Composition(2, 1),
        "ball": Composition(0, 3),
    }
)
"""Table 5, with the line of the planar joint corrected (see `FOOTNOTES`)."""

TABLE_7: Mapping[str, Comparison] = MappingProxyType(
    {
        "revolute": Comparison(Operations(222, 360), Operations(51, 45), (23.0, 12.5)),
        "translational": Comparison(Operations(504, 939), Operations(33, 9), (6.5, 1.0)),
        "screw": Comparison(Operations(564, 1074), Operations(60, 54), (10.6, 5.0)),
        "cylindrical": Comparison(Operations(420, 798), Operations(57, 54), (13.6, 6.8)),
        "universal": Comparison(Operations(138, 219), Operations(73, 114), (52.9, 52.1)),
        "planar": Comparison(Operations(294, 540), Operations(75, 63), (25.5, 11.7)),
        "ball": Comparison(Operations(54, 78), Operations(101, 386), (187.0, 494.4)),
    }
)
"""Table 7: operations of each joint, conventional and proposed."""

TABLE_8: tuple[Timing, ...] = (Timing(1, 0.09, 0.09), Timing(5, 0.42, 0.46), Timing(20, 1.70, 1.94))
"""Table 8: computation times of the in-line engine, s."""

FOOTNOTES: Mapping[str, Footnote] = MappingProxyType(
    {
        "planar": Footnote(
            place="Table 5, planar",
            printed="3 (2+0), trn2 and rot0",
            correct="3 (2+1), trn2 and rot1",
            reason="a planar joint turns about its normal; Table 6 (eq. 32) and Table 7 agree with rot1",
        ),
        "ball-rate": Footnote(
            place="Table 7, ball, second derivative, rate",
            printed="494.4",
            correct="494.9",
            reason="386 / 78 = 494.87 %",
        ),
        "table-8-unit": Footnote(
            place="Table 8, caption",
            printed="computation times (per second)",
            correct="computation times in seconds",
            reason="the head of its columns says (sec)",
        ),
    }
)
"""Misprints in the tables."""
