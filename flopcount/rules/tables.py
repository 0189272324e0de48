"""Tables 2 and 7 by the rules, the explanation of each of their numbers, and the verdict on each printed one.

Input: a constraint or joint, a derivative, a form; optionally an order of evaluation and switches. Output:
    counts and terms.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from flopcount import paper
from flopcount.paper import BASIC_CONSTRAINTS, DERIVATIVES, Derivative, Operations
from flopcount.rules import conventional, parametric
from flopcount.rules.expressions import Part
from flopcount.rules.ledger import PAPER, STRUCTURE, Method, Term, walk
from flopcount.rules.switches import SWITCHES, Cell, Form, Switch
from flopcount.rules.vectors import VECTORS

ORDERS: Mapping[str, Method] = MappingProxyType({"paper": PAPER, "vectors": VECTORS})
"""The orders of evaluation by name."""


class UnknownNameError(LookupError):
    """A name that is not in its list.

    Attributes:
        kind: what was looked for.
        name: the name.
        known: the names that there are.
    """

    def __init__(self, kind: str, name: str, known: Collection[str]) -> None:
        self.kind, self.name, self.known = kind, name, tuple(known)
        super().__init__(f'unknown {kind} "{name}"; known: {", ".join(known)}')


@dataclass(frozen=True, slots=True)
class Verdict:
    """How far one printed number can be reproduced.

    Attributes:
        cell: which number.
        printed: the number in the paper.
        by_rules: the number that the rules give.
        switch: the assumption under which they give the printed one, if there is one and it is needed.
    """

    cell: Cell
    printed: int
    by_rules: int
    switch: str | None

    @property
    def status(self) -> str:
        """The verdict in words."""
        if self.printed == self.by_rules:
            return "exact"
        return f"explained by {self.switch}" if self.switch else f"not reproduced ({self.by_rules})"


def parts(name: str, form: Form) -> tuple[Part, ...]:
    """The constraints that are counted for a basic constraint or a joint.

    Raises:
        UnknownNameError: no such form, basic constraint or joint.
    """
    _known("form", form, ("basic", "conventional", "parametric"))
    if form == "basic":
        _known("basic constraint", name, BASIC_CONSTRAINTS)
        return (conventional.BASIC[name],)
    _known("joint", name, paper.JOINTS)
    return conventional.JOINTS[name] if form == "conventional" else parametric.joint(name)


def explain(
    name: str, derivative: Derivative, form: Form, *, order: str = "paper", switches: Collection[str] = ()
) -> tuple[Term, ...]:
    """Derive one number term by term.

    Args:
        name: basic constraint (form ``basic``) or joint.
        derivative: ``phi_q`` or ``phi_q_t_lambda_q``.
        form: ``basic``, ``conventional`` or ``parametric``.
        order: ``paper`` (R2) or ``vectors``.
        switches: names of assumptions to make; only the paper's order has any.

    Returns:
        The operations in the order in which they are done, with a line of 0 for each free block.

    Raises:
        UnknownNameError: one of the names is unknown.
    """
    _known("derivative", derivative, DERIVATIVES)
    _known("order", order, ORDERS)
    for switch in switches:
        _known("switch", switch, SWITCHES if order == "paper" else ())
    assumptions = [SWITCHES[switch] for switch in SWITCHES if switch in switches]
    return tuple(term for part in parts(name, form) for term in _terms(part, derivative, ORDERS[order], assumptions))


def tally(
    name: str, derivative: Derivative, form: Form, *, order: str = "paper", switches: Collection[str] = ()
) -> int:
    """Count one number; the arguments are those of `explain`."""
    return sum(term.operations for term in explain(name, derivative, form, order=order, switches=switches))


def operations(name: str, form: Form, *, order: str = "paper", switches: Collection[str] = ()) -> Operations:
    """Count both derivatives; the arguments are those of `explain`."""
    first, second = (tally(name, d, form, order=order, switches=switches) for d in DERIVATIVES)
    return Operations(first, second)


def composed(name: str) -> Operations:
    """A conventional joint of Table 7 as Table 1's composition of the printed Table 2.

    Raises:
        UnknownNameError: no such joint.
    """
    _known("joint", name, paper.TABLE_1)
    total = Operations(0, 0)
    for basic, times in paper.TABLE_1[name].items():
        total = total + paper.TABLE_2[basic] * times
    return total


def printed(cell: Cell) -> int:
    """The number in the paper."""
    if cell.form == "basic":
        return paper.TABLE_2[cell.name].of(cell.derivative)
    line = paper.TABLE_7[cell.name]
    return (line.conventional if cell.form == "conventional" else line.proposed).of(cell.derivative)


def cells() -> Iterator[Cell]:
    """All numbers of Tables 2 and 7, in the order of the tables."""
    forms: tuple[Form, ...] = ("conventional", "parametric")
    yield from (Cell("basic", name, d) for name in BASIC_CONSTRAINTS for d in DERIVATIVES)
    yield from (Cell(form, name, d) for form in forms for name in paper.JOINTS for d in DERIVATIVES)


def verdicts() -> tuple[Verdict, ...]:
    """Judge every number of Tables 2 and 7."""
    return tuple(verdict(cell) for cell in cells())


def verdict(cell: Cell) -> Verdict:
    """Judge one number."""
    return Verdict(cell, printed(cell), tally(cell.name, cell.derivative, cell.form), _explaining(cell))


def _explaining(cell: Cell) -> str | None:
    for switch in SWITCHES.values():
        if cell in switch.explains:
            assumed = tally(cell.name, cell.derivative, cell.form, switches=(switch.name,))
            if assumed == printed(cell):
                return switch.name
    return None


def _terms(part: Part, derivative: Derivative, method: Method, assumptions: list[Switch]) -> tuple[Term, ...]:
    structure = dict(STRUCTURE)
    for switch in assumptions:
        structure.update(switch.structure)
    terms = walk(part, derivative, method, structure)
    for switch in assumptions:
        terms = switch.amend(part, derivative, terms)
    return terms


def _known(kind: str, name: str, known: Collection[str]) -> None:
    if name not in known:
        raise UnknownNameError(kind, name, known)
