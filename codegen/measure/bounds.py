"""Guaranteed bounds on the rounding errors of a program, over a whole box of inputs.

Each operation rounds with a relative error of at most u (sine and cosine: one unit in the last place, 2 u; arc tangent:
one and a half, 3 u) and, near underflow, an absolute one. The result is a function of these errors; by the mean value
theorem it differs from the exact one by the sum of error times derivative, the derivatives taken somewhere between. Arb
balls enclose all values in the box and under all errors, one reverse sweep for each output encloses the derivatives. A
fused multiply-add only leaves errors out, so that the bound holds for every contraction of products and sums.

Assumed besides: no overflow, and functions of the mathematical library as good as that.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field

from codegen.ir.ops import LEAVES, PROJECTIONS, Constant, Op
from codegen.ir.program import Program
from codegen.measure.enclosures import Ball, Enclosures

_PRECISION = 64
_EXACT_BITS = 24
"""Dyadic constants as short as this are exact in every number type."""

_FREE = LEAVES | PROJECTIONS | {Op.NEGATE, Op.SINCOS, Op.ABS, Op.SELECT}
_UNITS = {Op.SIN: 2, Op.COS: 2, Op.SINE_OF: 2, Op.COSINE_OF: 2, Op.ATAN2: 3}
"""Unit roundoffs that a function is off by; every other operation one."""


@dataclass(frozen=True, slots=True)
class Arithmetic:
    """How numbers round.

    Attributes:
        unit: unit roundoff u.
        tiny: largest error of an operation that underflows.
    """

    unit: float
    tiny: float


ARITHMETICS: dict[str, Arithmetic] = {
    "double": Arithmetic(2.0**-53, 2.0**-1074),
    "float": Arithmetic(2.0**-24, 2.0**-149),
}


@dataclass(frozen=True, slots=True, eq=False)
class Box:
    """Where inputs are.

    Attributes:
        inputs: argument -> (lowest, highest) of each entry.
        ranges: position of a value -> its largest magnitude, if inputs were exact rotations; see
            `codegen.measure.named_ranges`.
        deviation: (argument, entry) -> how far an entry may be from that of an exact rotation.
        reach: least distance from the origin of what arc tangents are taken of.
    """

    inputs: Mapping[str, list[tuple[float, float]]]
    ranges: Mapping[int, float] = field(default_factory=dict)
    deviation: Mapping[tuple[str, int], float] = field(default_factory=dict)
    reach: float = 0.0


def rounding_bounds(program: Program, box: Box, real: str, are_inputs_rounded: bool = False) -> dict[str, list[float]]:
    """Bound the rounding error of every output entry, for all inputs in a box.

    Args:
        program: as it is emitted; with or without fused operations.
        box: of the inputs.
        real: ``double`` or ``float``.
        are_inputs_rounded: whether the inputs are themselves rounded, so that the error is that against what they were
            rounded from; else they are exact.

    Returns:
        Output -> bound of each nonzero; infinite where there is none.
    """
    with _precision():
        sweep = _Sweep(program, box, ARITHMETICS[real], are_inputs_rounded)
        found: dict[int, float] = {}
        for output in program.outputs:
            for value in output.values:
                if value not in found:
                    found[value] = sweep.bound(value)
    return {output.name: [found[value] for value in output.values] for output in program.outputs}


@contextmanager
def _precision() -> Iterator[None]:
    import flint

    before, flint.ctx.prec = flint.ctx.prec, _PRECISION
    try:
        yield
    finally:
        flint.ctx.prec = before


class _Sweep:
    """Values of a program over a box and under all roundings, and what each rounding is at most."""

    def __init__(self, program: Program, box: Box, arithmetic: Arithmetic, are_inputs_rounded: bool) -> None:
        import flint

        self._arb = flint.arb
        self._program = program
        self._box = box
        self._arithmetic = arithmetic
        self._are_inputs_rounded = are_inputs_rounded
        self._over = Enclosures(box.reach)
        self._zero = flint.arb(0)
        self._values: list[Ball] = []
        self._errors: list[Ball] = []
        self._drifts: list[Ball] = []
        for position in range(len(program.instructions)):
            self._advance(position)
        self._partials: dict[int, list[Ball]] = {}

    def bound(self, output: int) -> float:
        """Sum error times derivative over all values that an output depends on."""
        adjoints = {output: self._over.one}
        total = self._zero
        for position in sorted(self._ancestors(output), reverse=True):
            adjoint = adjoints.pop(position)
            total += abs(adjoint) * self._errors[position]
            for operand, partial in zip(
                self._program.instructions[position].operands, self._partials_of(position), strict=True
            ):
                term = adjoint if partial is self._over.one else adjoint * partial
                adjoints[operand] = adjoints[operand] + term if operand in adjoints else term
        upper = total.abs_upper()
        return float(upper.mid() + upper.rad()) * (1 + 2.0**-50) if total.is_finite() else float("inf")

    def _ancestors(self, output: int) -> set[int]:
        seen, waiting = {output}, [output]
        while waiting:
            for operand in self._program.instructions[waiting.pop()].operands:
                if operand not in seen:
                    seen.add(operand)
                    waiting.append(operand)
        return seen

    def _advance(self, position: int) -> None:
        """Enclose a value, its rounding error, and its drift from what it is for exact rotations."""
        instruction = self._program.instructions[position]
        op = instruction.op
        operands = [self._values[operand] for operand in instruction.operands]
        if op is Op.INPUT and instruction.source is not None:
            argument, index = instruction.source
            low, high = self._box.inputs[argument][index]
            value = self._arb((low + high) / 2, abs(high - low) / 2 * (1 + 2.0**-50) + abs(high + low) * 2.0**-52)
            deviation = self._box.deviation.get(instruction.source)
            drift, error = self._arb(deviation or 0.0), self._zero
            if self._are_inputs_rounded:
                error = self._rounding(op, value) if deviation is None else drift
        elif op is Op.CONSTANT and instruction.constant is not None:
            rational = instruction.constant.rational
            value = self._arb(rational.numerator) / rational.denominator
            value *= self._arb.pi() ** instruction.constant.pi_power
            drift, error = self._zero, self._constant_error(instruction.constant, value)
        else:
            value = self._over.value(op, operands)
            error = self._zero if self._is_free(op) else self._rounding(op, value)
            drift = self._zero
            for operand, partial in zip(instruction.operands, self._over.slopes(op, operands), strict=True):
                drift = drift + abs(partial) * self._drifts[operand]
        drift = drift + error
        known = self._box.ranges.get(position)
        if known is not None:
            limit = self._arb(0, float((self._arb(known) + drift).abs_upper()) * (1 + 2.0**-50))
            value = self._tighter(value, limit)
        elif error is not self._zero:
            value = value + self._arb(0, 1) * error
        self._values.append(value)
        self._errors.append(error)
        self._drifts.append(drift)

    def _constant_error(self, constant: Constant, value: Ball) -> Ball:
        rational = constant.rational
        is_dyadic = rational.denominator & (rational.denominator - 1) == 0
        is_exact = is_dyadic and not constant.pi_power and rational.numerator.bit_length() <= _EXACT_BITS
        return self._zero if is_exact else abs(value) * self._arithmetic.unit

    def _is_free(self, op: Op) -> bool:
        return op in _FREE and op not in _UNITS

    def _rounding(self, op: Op, value: Ball) -> Ball:
        units = _UNITS.get(op, 1)
        return abs(value).abs_upper() * (units * self._arithmetic.unit) + self._arithmetic.tiny

    def _tighter(self, value: Ball, limit: Ball) -> Ball:
        if not value.is_finite() or limit.rad() < abs(value).abs_upper():
            return limit
        return value

    def _partials_of(self, position: int) -> list[Ball]:
        if position not in self._partials:
            instruction = self._program.instructions[position]
            operands = [self._values[operand] for operand in instruction.operands]
            self._partials[position] = self._over.slopes(instruction.op, operands)
        return self._partials[position]
