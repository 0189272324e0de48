"""Assumptions, off by default, that would explain printed cells which the rules do not give.

Input: the terms of one part. Output: the terms under the assumption. A switch is no rule: each of them
contradicts either the mathematics or the paper's other cells, and says so.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Literal, TypeAlias

from flopcount.paper import Derivative
from flopcount.rules import patterns
from flopcount.rules.expressions import Part
from flopcount.rules.ledger import Term
from flopcount.rules.patterns import Pattern

Form = Literal["basic", "conventional", "parametric"]
"""``basic``: a constraint of Table 2; ``conventional`` and ``parametric``: a joint of Table 7."""

Terms: TypeAlias = tuple[Term, ...]


@dataclass(frozen=True, slots=True)
class Cell:
    """One number of Table 2 or Table 7.

    Attributes:
        form: which table, and which half of it.
        name: the basic constraint or the joint.
        derivative: which derivative.
    """

    form: Form
    name: str
    derivative: Derivative

    def __str__(self) -> str:
        table = "Table 2" if self.form == "basic" else f"Table 7, {self.form}"
        return f"{table}, {self.name}, {self.derivative}"


def _unchanged(part: Part, derivative: Derivative, terms: Terms) -> Terms:
    del part, derivative
    return terms


@dataclass(frozen=True, slots=True)
class Switch:
    """One assumption.

    Attributes:
        name: of the switch.
        assumption: what is assumed.
        justification: what speaks for it, and what against.
        explains: cells that it brings to the printed number.
        also_changes: cells that it changes without explaining them.
        amend: the terms of a part under the assumption.
        structure: matrices with structural zeros under the assumption.
    """

    name: str
    assumption: str
    justification: str
    explains: tuple[Cell, ...]
    also_changes: tuple[Cell, ...] = ()
    amend: Callable[[Part, Derivative, Terms], Terms] = _unchanged
    structure: Mapping[str, Pattern] = field(default_factory=dict)

    @property
    def changes(self) -> tuple[Cell, ...]:
        """All cells that it changes."""
        return self.explains + self.also_changes


def _scale_spherical(part: Part, derivative: Derivative, terms: Terms) -> Terms:
    if part.name != "spherical" or derivative != "phi_q_t_lambda_q":
        return terms
    words = "the block scaled by lambda once more"
    extra = (
        Term(part.label, block.place, words, patterns.MATRIX.numbers, "spherical-scaled")
        for block in part.phi_q_t_lambda_q
    )
    return (*terms, *extra)


def _drop_screw_addition(part: Part, derivative: Derivative, terms: Terms) -> Terms:
    if part.name != "screw" or derivative != "phi_q":
        return terms
    last = max(at for at, term in enumerate(terms) if term.place == "(screw, pi_i)")
    free = replace(terms[last], operations=0, rule="screw-addition")
    return (*terms[:last], free, *terms[last + 1 :])


def _double_planar_sum(part: Part, derivative: Derivative, terms: Terms) -> Terms:
    if part.name != "trn2" or derivative != "phi_q":
        return terms
    again = (
        replace(term, text=f"again {term.text}", rule="planar-twice") for term in terms if term.place == "(trn2, pi_i)"
    )
    return (*terms, *again)


def _second(form: Form, *names: str) -> tuple[Cell, ...]:
    return tuple(Cell(form, name, "phi_q_t_lambda_q") for name in names)


SWITCHES: Mapping[str, Switch] = MappingProxyType(
    {
        "spherical-scaled": Switch(
            name="spherical-scaled",
            assumption="Each of the two blocks of the spherical constraint's second derivative is scaled "
            "by lambda (9) once more.",
            justification="78 - 60 = 18 = 2 x 9, the scaling that R4 adds to each block of a scalar "
            "constraint. Against it: here lambda is a vector and already inside, s_i~ (A_i^T "
            "lambda)~; no scaling is left to do.",
            explains=(
                *_second("basic", "spherical"),
                *_second("conventional", "revolute", "universal", "ball"),
            ),
            amend=_scale_spherical,
        ),
        "screw-addition": Switch(
            name="screw-addition",
            assumption="In the screw constraint's Jacobian the addition of p h_i^T to the block of pi_i is "
            "not counted.",
            justification="147 - 144 = 3, the addition of two rows. Against it: the addition of p h_i^T "
            "A_ij in the block of pi_j is counted.",
            explains=(Cell("basic", "screw", "phi_q"), Cell("conventional", "screw", "phi_q")),
            amend=_drop_screw_addition,
        ),
        "zero-row": Switch(
            name="zero-row",
            assumption="The third row of dA_ij/dalpha is structurally zero for the first rotational coordinate.",
            justification="D^T lambda then costs 9 for 15. It holds if C_i = I (joint axes parallel to the "
            "axes of body i), since the third row of d(Rz)/dalpha is zero. It "
            "explains all five second derivatives that are 6 too high. Against it: the same "
            "formulas count f_i, g_i, h_i as general vectors, and the ball joint moves away "
            "from its cell.",
            explains=_second("parametric", "revolute", "screw", "cylindrical", "universal", "planar"),
            also_changes=_second("parametric", "ball"),
            structure=MappingProxyType({"D_1": patterns.MATRIX.without_row(2)}),
        ),
        "planar-twice": Switch(
            name="planar-twice",
            assumption="In the planar joint's Jacobian s_i~ + f_i~ alpha_1 + g_i~ alpha_2 is counted twice.",
            justification="75 - 63 = 12, the cost of that sum. Against it: the corresponding sum of the "
            "translational, screw and cylindrical joints is counted once.",
            explains=(Cell("parametric", "planar", "phi_q"),),
            amend=_double_planar_sum,
        ),
    }
)
"""The switches by name."""
