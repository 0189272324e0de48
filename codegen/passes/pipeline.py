"""The order of the passes."""

from __future__ import annotations

from codegen.ir.program import Program
from codegen.passes.absorb_negations import absorb_negations
from codegen.passes.drop_unused import drop_unused
from codegen.passes.eliminate_zeros import compress, without_zeros
from codegen.passes.fold_constants import folded
from codegen.passes.pair_sincos import pair_sincos
from codegen.passes.regroup_products import regroup_products
from codegen.passes.rewrite import rebuild
from codegen.passes.schedule import schedule
from codegen.passes.share_subexpressions import share_subexpressions


def simplify(program: Program) -> Program:
    """Bring a freshly lowered program into the form that is emitted and counted."""
    while True:
        cleaned = rebuild(program, folded, without_zeros)
        if cleaned.instructions == program.instructions:
            break
        program = drop_unused(share_subexpressions(cleaned))
    shared = drop_unused(share_subexpressions(compress(program)))
    return schedule(absorb_negations(pair_sincos(shared)))


def shorten(program: Program) -> Program:
    """Simplify a program and regroup its products, which rounds them in another order."""
    simple = simplify(program)
    regrouped = regroup_products(simple)
    return simple if regrouped is simple else schedule(absorb_negations(regrouped))
