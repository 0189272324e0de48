"""Passes are idempotent and none adds an operation.

`pair_sincos` wants equal angles to be one value: it runs behind `share_subexpressions`.
"""

from __future__ import annotations

from hypothesis import given

from codegen.ir.program import Program
from codegen.passes import simplify
from codegen.passes.pair_sincos import pair_sincos
from codegen.passes.share_subexpressions import share_subexpressions
from flopcount.count import count
from tests.ir.programs import OPS, RANDOM, programs, tree

from .test_values import PASSES


@RANDOM
@given(programs(ops=OPS, pi=True))
def test_passes_are_idempotent(program: Program) -> None:
    for apply in PASSES:
        if apply is not simplify:
            once = apply(share_subexpressions(program) if apply is pair_sincos else program)
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
