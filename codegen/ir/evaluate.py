"""Evaluate a program over a number type: float, numpy array, Fraction, Arb ball, mpmath number, any with operators.

A `Domain` says how an exact constant becomes a number, how the transcendental functions are called and how a product
and a sum are rounded at once; sums and products are the type's own operators.
"""

from __future__ import annotations

import math
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
    values: list[Number] = []
    for instruction in program.instructions:
        operands = [values[operand] for operand in instruction.operands]
        if instruction.op is Op.CONSTANT:
            if instruction.constant is None:
                raise InternalError("a constant without a value")
            values.append(domain.constant(instruction.constant))
        elif instruction.op is Op.INPUT:
            if instruction.source is None:
                raise InternalError("an input without a source")
            values.append(inputs[instruction.source[0]][instruction.source[1]])
        else:
            values.append(_apply(instruction.op, operands, domain))
    return {output.name: [values[position] for position in output.values] for output in program.outputs}


def _apply(op: Op, operands: list[Number], domain: Domain) -> Number:
    match op:
        case Op.NEGATE:
            return -operands[0]
        case Op.ADD:
            return operands[0] + operands[1]
        case Op.SUBTRACT:
            return operands[0] - operands[1]
        case Op.MULTIPLY:
            return operands[0] * operands[1]
        case Op.DIVIDE:
            return operands[0] / operands[1]
        case Op.FMA:
            return domain.fma(operands[0], operands[1], operands[2])
        case Op.SQRT:
            return domain.sqrt(operands[0])
        case Op.SIN:
            return domain.sin(operands[0])
        case Op.COS:
            return domain.cos(operands[0])
        case Op.SINCOS:
            return domain.sin(operands[0]), domain.cos(operands[0])
        case Op.SINE_OF:
            return operands[0][0]
        case Op.COSINE_OF:
            return operands[0][1]
        case Op.ATAN2:
            return domain.atan2(operands[0], operands[1])
        case Op.ABS:
            return abs(operands[0])
        case Op.SELECT:
            return domain.select(operands[0], operands[1], operands[2], operands[3])
    raise InternalError(f"no evaluation for {op}")
