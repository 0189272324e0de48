"""Evaluate a program over a number type: float, numpy array, Fraction, Arb ball, mpmath number, any with operators.

A `Domain` says how an exact constant becomes a number, how the transcendental functions are called and how a product
and a sum are rounded at once; sums and products are the type's own operators.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from codegen.errors import InternalError
from codegen.ir.fused import fused_multiply_add, fused_multiply_add_arrays
from codegen.ir.nearest import nearest_double
from codegen.ir.ops import Constant, Op
from codegen.ir.program import Program

Number = Any
"""A value of the domain: the evaluator uses its operators only."""


def _product_and_sum(a: Number, b: Number, c: Number) -> Number:
    return a * b + c


def _chosen(a: Number, b: Number, x: Number, y: Number) -> Number:
    return x if a < b else y


@dataclass(frozen=True, slots=True)
class Domain:
    """A number type.

    Attributes:
        name: for messages.
        constant: exact constant -> number.
        sqrt: square root.
        sin: sine.
        cos: cosine.
        atan2: angle of (y, x).
        fma: ``a b + c``, rounded once where the type rounds; the plain operators in an exact or enclosing type.
        select: ``x`` where ``a < b``, ``y`` elsewhere, of (a, b, x, y).
    """

    name: str
    constant: Callable[[Constant], Number]
    sqrt: Callable[[Number], Number]
    sin: Callable[[Number], Number]
    cos: Callable[[Number], Number]
    atan2: Callable[[Number, Number], Number]
    fma: Callable[[Number, Number, Number], Number] = _product_and_sum
    select: Callable[[Number, Number, Number, Number], Number] = _chosen


def _fraction_constant(constant: Constant) -> Fraction:
    if constant.pi_power:
        raise ArithmeticError("pi is not rational")
    return constant.rational


def _not_rational(*_: Number) -> Number:
    raise ArithmeticError("the program is not rational")


def float_domain() -> Domain:
    """Python floats (IEEE double)."""
    return Domain("float", nearest_double, math.sqrt, math.sin, math.cos, math.atan2, fused_multiply_add)


def fraction_domain() -> Domain:
    """Exact rationals; a program with roots or angles raises `ArithmeticError`."""
    return Domain("Fraction", _fraction_constant, _not_rational, _not_rational, _not_rational, _not_rational)


def numpy_domain() -> Domain:
    """Numpy arrays, elementwise: many poses at once."""
    import numpy

    def select(a: Number, b: Number, x: Number, y: Number) -> Number:
        return numpy.where(a < b, x, y)

    functions = (numpy.sqrt, numpy.sin, numpy.cos, numpy.arctan2)
    return Domain("numpy", nearest_double, *functions, fused_multiply_add_arrays, select)


def arb_domain() -> Domain:
    """Arb balls of python-flint at the precision set in ``flint.ctx.prec``: rigorous enclosures."""
    import flint

    def constant(value: Constant) -> Number:
        rational = flint.arb(value.rational.numerator) / value.rational.denominator
        return rational * flint.arb.pi() ** value.pi_power if value.pi_power else rational

    def select(a: Number, b: Number, x: Number, y: Number) -> Number:
        if a < b:
            return x
        return y if a >= b else x.union(y)

    return Domain(
        "arb",
        constant,
        lambda x: x.sqrt(),
        lambda x: x.sin(),
        lambda x: x.cos(),
        lambda y, x: flint.arb.atan2(y, x),
        select=select,
    )


def mpmath_domain() -> Domain:
    """Mpmath numbers at the precision set in ``mpmath.mp``."""
    import mpmath

    def constant(value: Constant) -> Number:
        return mpmath.mpf(value.rational.numerator) / value.rational.denominator * mpmath.pi**value.pi_power

    return Domain("mpmath", constant, mpmath.sqrt, mpmath.sin, mpmath.cos, mpmath.atan2)


def evaluate(
    program: Program, inputs: Mapping[str, Sequence[Number]], domain: Domain | None = None
) -> dict[str, list[Number]]:
    """Evaluate every output of the program.

    Args:
        program: what to evaluate.
        inputs: for each used argument its entries, column-major.
        domain: the number type; floats if left out.

    Returns:
        For each output its structural nonzeros in storage order.

    Raises:
        KeyError: an argument that the program uses is missing.
        ArithmeticError: the domain cannot represent an operation.
    """
    domain = domain or float_domain()
    rules = _rules(domain)
    values: list[Number] = []
    for op, operands, constant, source, _ in program.instructions:
        if op is Op.CONSTANT:
            if constant is None:
                raise InternalError("a constant without a value")
            values.append(domain.constant(constant))
        elif op is Op.INPUT:
            if source is None:
                raise InternalError("an input without a source")
            values.append(inputs[source[0]][source[1]])
        elif len(operands) == 2:
            first, second = operands
            values.append(rules[op](values[first], values[second]))
        else:
            values.append(rules[op](*[values[operand] for operand in operands]))
    return {output.name: [values[position] for position in output.values] for output in program.outputs}


def _rules(domain: Domain) -> Mapping[Op, Callable[..., Number]]:
    """What each operation does to its operands."""
    return {
        Op.NEGATE: operator.neg,
        Op.ADD: operator.add,
        Op.SUBTRACT: operator.sub,
        Op.MULTIPLY: operator.mul,
        Op.DIVIDE: operator.truediv,
        Op.FMA: domain.fma,
        Op.SQRT: domain.sqrt,
        Op.SIN: domain.sin,
        Op.COS: domain.cos,
        Op.SINCOS: lambda angle: (domain.sin(angle), domain.cos(angle)),
        Op.SINE_OF: operator.itemgetter(0),
        Op.COSINE_OF: operator.itemgetter(1),
        Op.ATAN2: domain.atan2,
        Op.ABS: abs,
        Op.SELECT: domain.select,
    }
