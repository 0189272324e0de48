"""Products of three take a product that is there anyway; programs by hand."""

from __future__ import annotations

from fractions import Fraction

import pytest

from codegen.ir.builder import Builder
from codegen.ir.evaluate import evaluate, fraction_domain
from codegen.ir.ops import Op
from codegen.ir.program import Argument, Output, Program, Sparsity
from codegen.passes.regroup_products import regroup_products
from flopcount.count import count

INPUTS = {"x": [Fraction(k, 7) for k in (3, -5, 2, 11, 13, -17, 19)]}


def scaled_outer_product(with_cross: bool) -> Program:
    """``a (s b)^T`` of two vectors, beside ``a . b`` and, where it is asked for, ``a x b``."""
    builder = Builder()
    a, b = ([builder.input("x", start + k) for k in range(3)] for start in (0, 3))
    s = builder.input("x", 6)

    def times(p: int, q: int) -> int:
        return builder.emit(Op.MULTIPLY, p, q)

    scaled = [times(s, entry) for entry in b]
    values = [times(p, q) for p in a for q in scaled]
    dot = builder.emit(Op.ADD, builder.emit(Op.ADD, times(a[0], b[0]), times(a[1], b[1])), times(a[2], b[2]))
    crossed = [(1, 2), (2, 0), (0, 1)] if with_cross else []
    cross = [builder.emit(Op.SUBTRACT, times(a[p], b[q]), times(a[q], b[p])) for p, q in crossed]
    values += [dot, *cross]
    pattern = Sparsity.of_entries(len(values), 1, [(k, 0) for k in range(len(values))])
    return builder.freeze((Argument("x", (7, 1)),), (Output("y", pattern, tuple(values)),), {})


@pytest.mark.parametrize("with_cross", [True, False])
def test_the_values_stay_the_same_in_exact_arithmetic(with_cross: bool) -> None:
    program = scaled_outer_product(with_cross)
    domain = fraction_domain()
    assert evaluate(regroup_products(program), INPUTS, domain) == evaluate(program, INPUTS, domain)


def test_a_scaled_vector_is_dropped_where_every_product_of_the_two_vectors_is_there() -> None:
    program = scaled_outer_product(with_cross=True)
    assert count(regroup_products(program)).total == count(program).total - 3


def test_a_program_in_which_nothing_can_be_dropped_stays_as_it_is() -> None:
    program = scaled_outer_product(with_cross=False)
    assert regroup_products(program) is program
