"""Programs of scenes without the long search: any choice gives the same quantities."""

from __future__ import annotations

import random
from collections.abc import Sequence

from codegen.ir.evaluate import evaluate
from codegen.ir.lower import lower
from codegen.ir.lower.graph import Choice, Graph
from codegen.ir.program import Program
from codegen.mechanics.assembly import Assembly
from codegen.models import PRICES
from codegen.passes import simplify
from codegen.passes.select import select
from tests.lower.models import random_choice
from tests.lower.numbers import EXACT, Inputs, Numbers

from .library import dense

ALL = ("phi", "phi_q", "phi_q_t_lambda_q", "gamma", "phi_q_v", "phi_q_t_lambda")


def any_program(assembly: Assembly, names: Sequence[str] = ALL, seed: int = 0) -> Program:
    """Lower quantities of a scene, each node in some way."""
    source = random.Random(seed)

    def choose(graph: Graph, _: Sequence[int]) -> list[Choice]:
        return [random_choice(graph, source, set())]

    (found,) = lower(assembly.arguments(), assembly.inputs(), assembly.parts(names), PRICES, choose)
    return simplify(select(found, {name: assembly.selection(name) for name in names}))


def values(program: Program, inputs: Inputs) -> dict[str, Numbers]:
    """Quantities in exact numbers, dense."""
    found = evaluate(program, inputs, EXACT)
    return {output.name: dense(output, found[output.name], 0) for output in program.outputs}
