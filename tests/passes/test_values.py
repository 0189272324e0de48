"""No pass changes the value of an output in exact arithmetic; those that claim it keep the floats bit for bit.

The sign of a zero is not held: ``-(a - b)`` and ``b - a`` differ in it where a = b. Arc tangents see the sign of a
zero, so they are left out of the comparison of bits.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

import flint
from hypothesis import assume, given
from hypothesis import strategies as st

from codegen.ir.evaluate import arb_domain, float_domain, fraction_domain
from codegen.ir.ops import Op
from codegen.ir.program import Program
from codegen.passes import simplify
from codegen.passes.absorb_negations import absorb_negations
from codegen.passes.alternate import alternate
from codegen.passes.drop_unused import drop_unused
from codegen.passes.eliminate_zeros import compress, eliminate_zeros
from codegen.passes.fold_constants import fold_constants
from codegen.passes.overlap import overlap
from codegen.passes.pair_sincos import pair_sincos
from codegen.passes.schedule import schedule
from codegen.passes.share_subexpressions import share_subexpressions
from tests.ir.programs import FUSED_OPS, OPS, RANDOM, bits, inputs_of, matrices, programs, small_fractions

Pass = Callable[[Program], Program]

EXACT: tuple[Pass, ...] = (fold_constants, eliminate_zeros, simplify)
BITWISE: tuple[Pass, ...] = (
    share_subexpressions,
    absorb_negations,
    schedule,
    overlap,
    alternate,
    pair_sincos,
    drop_unused,
    compress,
)
PASSES: tuple[Pass, ...] = (*EXACT, *BITWISE)
NO_ROOTS = (*FUSED_OPS, Op.DIVIDE)


@RANDOM
@given(programs(ops=NO_ROOTS), inputs_of(small_fractions()))
def test_passes_keep_the_value_of_every_output(program: Program, inputs: dict[str, list[Fraction]]) -> None:
    try:
        expected = matrices(program, inputs, fraction_domain())
    except ZeroDivisionError:
        assume(False)
        return
    for apply in PASSES:
        changed = matrices(apply(program), inputs, fraction_domain())
        assert set(changed) <= set(expected), apply
        assert {entry: changed.get(entry, Fraction(0)) for entry in expected} == expected, apply


@RANDOM
@given(programs(ops=OPS, pi=True), inputs_of(st.floats(0.25, 2.0)))
def test_passes_keep_roots_and_angles_within_their_enclosures(program: Program, inputs: dict[str, list[float]]) -> None:
    before = flint.ctx.prec
    flint.ctx.prec = 200
    try:
        balls = {name: [flint.arb(value) for value in values] for name, values in inputs.items()}
        expected = matrices(program, balls, arb_domain())
        for apply in PASSES:
            changed = matrices(apply(program), balls, arb_domain())
            for entry, ball in expected.items():
                if ball.is_finite():
                    assert ball.overlaps(changed.get(entry, flint.arb(0))), apply
    finally:
        flint.ctx.prec = before


@RANDOM
@given(
    programs(ops=(*NO_ROOTS, Op.SIN, Op.COS), pi=True),
    inputs_of(st.floats(-100, 100, allow_subnormal=False)),
)
def test_passes_that_claim_so_keep_the_bits_of_floats(program: Program, inputs: dict[str, list[float]]) -> None:
    try:
        expected = matrices(program, inputs, float_domain())
    except (ArithmeticError, ValueError):
        assume(False)
        return
    for apply in BITWISE:
        changed = matrices(apply(program), inputs, float_domain())
        for entry, value in expected.items():
            assert bits(changed.get(entry, 0.0)) == bits(value), (apply, entry)


@RANDOM
@given(programs(ops=OPS, pi=True))
def test_passes_keep_arguments_shapes_and_the_legend(program: Program) -> None:
    for apply in PASSES:
        changed = apply(program)
        assert (changed.arguments, changed.legend) == (program.arguments, program.legend), apply
        for before, after in zip(program.outputs, changed.outputs, strict=True):
            assert after.name == before.name, apply
            assert (after.sparsity.nrow, after.sparsity.ncol) == (before.sparsity.nrow, before.sparsity.ncol), apply
            assert apply in (compress, simplify) or after.sparsity == before.sparsity, apply
