"""The derivation of a cell of S1 Table 2 or 7 by the paper's rules, term by term."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from flopcount.paper import BASIC_CONSTRAINTS, DERIVATIVES, JOINTS
from flopcount.rules import RULES, Form, UnknownNameError, explain


def explanation(name: str, table: str, assume: Collection[str]) -> Iterator[str]:
    """Write the derivation of both derivatives of a joint or a basic constraint.

    Args:
        name: joint or basic constraint.
        table: ``2`` for basic constraints only; otherwise "screw" is the joint.
        assume: switches to set.

    Raises:
        UnknownNameError: no such joint, basic constraint or switch.
    """
    known = BASIC_CONSTRAINTS if table == "2" else tuple(dict.fromkeys((*JOINTS, *BASIC_CONSTRAINTS)))
    if name not in known:
        raise UnknownNameError("joint or basic constraint", name, known)
    forms: tuple[Form, ...] = ("conventional", "parametric") if name in JOINTS and table != "2" else ("basic",)
    for form in forms:
        for derivative in DERIVATIVES:
            terms = explain(name, derivative, form, switches=assume)
            yield f"{name}, {form}, {derivative}: {sum(term.operations for term in terms)}"
            yield from (f"  {term}" for term in terms)
    yield "Rules"
    yield from (f"  {number}: {rule.statement}" for number, rule in RULES.items())
