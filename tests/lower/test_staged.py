"""Expressions lowered in stages keep their value, their zeros and their order."""

from __future__ import annotations

from fractions import Fraction

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

from codegen.errors import InternalError
from codegen.ir.evaluate import evaluate, fraction_domain
from codegen.ir.lower.staged import Stages
from codegen.ir.ops import Op
from codegen.passes import simplify

_X = sympy.symbols("x[0] x[1] x[2]", real=True)
_LEAVES = st.one_of(st.sampled_from(_X), st.fractions(-3, 3, max_denominator=4).map(sympy.Rational))
_EXPRESSIONS = st.recursive(
    _LEAVES,
    lambda inner: st.one_of(
        st.tuples(inner, inner).map(lambda pair: pair[0] + pair[1]),
        st.tuples(inner, inner).map(lambda pair: pair[0] - pair[1]),
        st.tuples(inner, inner).map(lambda pair: pair[0] * pair[1]),
        st.tuples(inner, st.integers(1, 4)).map(lambda pair: pair[0] ** pair[1]),
        st.tuples(inner, inner).map(lambda pair: pair[0] / (pair[1] ** 2 + 1)),
    ),
    max_leaves=8,
)


@settings(max_examples=60, deadline=None)
@given(
    first=st.lists(_EXPRESSIONS, min_size=2, max_size=2),
    second=_EXPRESSIONS,
    point=st.lists(st.fractions(-2, 2, max_denominator=5), min_size=3, max_size=3),
    is_paired=st.booleans(),
)
def test_a_staged_program_has_the_exact_value_of_its_expressions(first, second, point, is_paired):
    stages = Stages(is_paired)
    x = stages.argument("x", 3)
    named = stages.stage("a", sympy.Matrix(first), "a")
    value = second.subs(dict(zip(_X, [*named, x[2]], strict=True)), simultaneous=True)
    stages.output("y", sympy.Matrix([value]))
    (found,) = evaluate(simplify(stages.program()), {"x": point}, fraction_domain())["y"] or [0]

    numbers = dict(zip(_X, map(sympy.Rational, point), strict=True))
    inner = [sympy.sympify(entry).subs(numbers, simultaneous=True) for entry in first]
    truth = second.subs(dict(zip(_X, [*inner, numbers[_X[2]]], strict=True)), simultaneous=True)
    assert Fraction(int(truth.p), int(truth.q)) == found


def test_zeros_and_signs_pass_through_a_stage():
    stages = Stages()
    x = stages.argument("x", 2, 2)
    named = stages.stage("a", sympy.Matrix([[0, -x[0, 1]], [x[0, 0] * x[1, 1], 1]]), "a")
    assert named[0, 0] == 0
    assert named[0, 1] == -x[0, 1]
    assert named[1, 1] == 1
    stages.output("y", named.T)
    program = simplify(stages.program())
    assert program.output("y").sparsity.entries() == [(1, 0), (0, 1), (1, 1)]
    assert evaluate(program, {"x": [2.0, 3.0, 5.0, 7.0]})["y"] == [-5.0, 14.0, 1.0]


def test_what_is_added_in_a_stage_is_added_first():
    stages = Stages()
    x = stages.argument("x", 3)
    near = stages.stage("near", sympy.Matrix([x[1] - x[2]]), "x_1 - x_2")
    stages.output("y", sympy.Matrix([x[0] + near[0]]))
    assert evaluate(simplify(stages.program()), {"x": [1.0, 1e17, 1e17]})["y"] == [1.0]


def test_functions_roots_and_quotients_become_one_operation_each():
    stages = Stages()
    x = stages.argument("x", 2)
    stages.output("y", sympy.Matrix([sympy.sqrt(x[0]) / x[1], sympy.atan2(x[0], x[1]), 1 / sympy.sqrt(x[0])]))
    ops = [instruction.op for instruction in simplify(stages.program()).instructions if instruction.operands]
    assert sorted(op.value for op in ops) == sorted([Op.SQRT.value, Op.DIVIDE.value, Op.ATAN2.value, Op.DIVIDE.value])


def test_what_has_no_operation_is_refused():
    stages = Stages()
    x = stages.argument("x", 1)
    with pytest.raises(InternalError, match="no operation for"):
        stages.output("y", sympy.Matrix([sympy.exp(x[0])]))
    stages.stage("a", sympy.Matrix([x[0] ** 2]), "x^2")
    with pytest.raises(InternalError, match="two stages"):
        stages.stage("a", sympy.Matrix([x[0] ** 3]), "x^3")
