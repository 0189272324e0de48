"""The pipeline for scenes: scene -> assembly -> program -> C, CasADi, manifest.

The stages are those of `codegen.build`; before them the joints get their forms and redundant rows are left out.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from codegen.cache import kept
from codegen.ir.lower import lower, structural_rows
from codegen.ir.lower.lowering import Choose
from codegen.ir.lower.search import Choice, Graph, cheapest
from codegen.ir.program import Program
from codegen.mechanics.assembly import Assembly
from codegen.mechanics.system import System
from codegen.models import PRICES, choices_for
from codegen.passes import simplify
from codegen.passes.select import select
from codegen.spec.sections import alike
from flopcount.count import count

HURRY = 20_000
"""Switches of a search in a hurry: about a second. Most mechanisms of a dozen bodies take fewer."""


def estimate(graph: Graph, outputs: Sequence[int]) -> list[Choice]:
    """Choose among the ways to evaluate nodes in a hurry: to compare forms, and for a run."""
    return [cheapest(graph, outputs, sweeps=1, switches=HURRY)]


def without_zero_rows(assembly: Assembly) -> Assembly:
    """Leave out the rows that are identically zero, as those across the plane of a planar mechanism are."""
    first = [placed.ends.first_row for placed in assembly.placed]
    zero: set[int] = set()
    for sections in alike(assembly.scene):
        alone = Assembly(sections[-1].scene(assembly.scene), assembly.forms)
        inputs = alone.inputs()
        rows = set().union(*(structural_rows(part, inputs) for part in alone.parts(("phi",))))
        missing = set(range(alone.all_rows)) - rows
        zero |= {first[section.joints.start] + row for section in sections for row in missing}
    return replace(assembly, dropped=assembly.dropped | zero)


def program(assembly: Assembly | System, names: Iterable[str], choose: Choose = choices_for) -> Program:
    """Lower quantities of the constraints of a scene to one simplified program, the cheapest that is found.

    Args:
        assembly: the scene with the forms of its joints; a `System` has its drives and forces too.
        names: ``phi``, ``phi_q``, ``phi_q_t_lambda_q``, ``gamma``, ``phi_q_v``, ``phi_q_t_lambda``.
        choose: among the ways to evaluate them; what is chosen by `choices_for` and `estimate` is kept between runs.
    """
    wanted = tuple(names)
    if choose not in (choices_for, estimate):
        return _cheapest(assembly, wanted, choose)
    what = ("program of a scene", assembly, wanted, choose.__name__)
    return kept(what, lambda: _cheapest(assembly, wanted, choose))


def _cheapest(assembly: Assembly | System, names: tuple[str, ...], choose: Choose) -> Program:
    chosen = {name: assembly.selection(name) for name in names}
    parts = assembly.parts(names)
    programs = lower(assembly.arguments(), assembly.inputs(), parts, PRICES, choose)
    return min((simplify(select(found, chosen)) for found in programs), key=lambda found: count(found).total)
