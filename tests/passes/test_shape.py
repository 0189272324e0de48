"""Passes are idempotent and none adds an operation.

Some passes want what an earlier one leaves: equal angles are one value, every value has a use.
"""

from __future__ import annotations

from hypothesis import given

from codegen.ir.program import Program
from codegen.passes import simplify
from codegen.passes.absorb_negations import absorb_negations
from codegen.passes.drop_unused import drop_unused
from codegen.passes.pair_sincos import pair_sincos
from codegen.passes.share_subexpressions import share_subexpressions
from flopcount.count import count
from tests.ir.programs import OPS, RANDOM, programs, tree

from .test_values import PASSES, Pass

PREPARED: dict[Pass, Pass] = {pair_sincos: share_subexpressions, absorb_negations: drop_unused}
"""What runs before a pass."""


@RANDOM
@given(programs(ops=OPS, pi=True))
def test_passes_are_idempotent(program: Program) -> None:
    for apply in PASSES:
        if apply is not simplify:
            once = apply(PREPARED[apply](program) if apply in PREPARED else program)
            assert apply(once) == once, apply


@RANDOM
@given(programs(ops=OPS, pi=True))
def test_simplify_is_idempotent_but_for_the_order_of_instructions(program: Program) -> None:
    known: dict[object, int] = {}
    once = simplify(program)
    assert tree(simplify(once), known) == tree(once, known)


@RANDOM
@given(programs(ops=OPS, pi=True))
def test_no_pass_adds_an_operation(program: Program) -> None:
    before = count(program)
    for apply in PASSES:
        after = count(apply(program))
        assert after.total <= before.total, apply
