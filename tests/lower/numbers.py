"""Exact numbers for the vector level: rational rotations and inputs, and stand-ins for the functions of an angle.

Sine and cosine are a rational point of the unit circle, so that ``s^2 + c^2 = 1`` holds exactly; the arc tangent is
some rational function, the same wherever its arguments are. No addition theorem holds, and none is used.
"""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from codegen.ir.evaluate import Domain
from codegen.ir.ops import Constant
from codegen.mechanics import frames
from codegen.models import Model
from codegen.spec.request import Variant
from tests.truth.cases import has_unit_quaternions

Numbers = NDArray[Any]
"""Array of fractions."""

Inputs = dict[str, list[Fraction]]
"""Argument -> entries, column-major."""

PI = Fraction(355, 113)


def sine(angle: Fraction) -> Fraction:
    """Second coordinate of the point of the unit circle that stands for an angle."""
    return 2 * angle / (1 + angle * angle)


def cosine(angle: Fraction) -> Fraction:
    """First coordinate of the same point."""
    return (1 - angle * angle) / (1 + angle * angle)


def arc_tangent(y: Fraction, x: Fraction) -> Fraction:
    """Some function of two numbers that is not symmetric in them."""
    return y / (1 + x * x)


def _constant(value: Constant) -> Fraction:
    return value.rational * PI**value.pi_power


def _no_root(_: Fraction) -> Fraction:
    raise ArithmeticError("no square root is expected")


EXACT = Domain("exact", _constant, _no_root, sine, cosine, arc_tangent)
"""Fractions with the stand-ins."""


def fraction(source: random.Random) -> Fraction:
    """A small fraction, not zero."""
    return Fraction(source.choice([-5, -4, -3, -2, -1, 1, 2, 3, 4, 5]), source.choice([1, 2, 3]))


def vector(source: random.Random) -> Numbers:
    """Three small fractions."""
    return np.array([fraction(source) for _ in range(3)], dtype=object)


def skew(a: Sequence[Fraction]) -> Numbers:
    """``a~`` with ``a~ b = a x b``."""
    zero = Fraction(0)
    return np.array([[zero, -a[2], a[1]], [a[2], zero, -a[0]], [-a[1], a[0], zero]], dtype=object)


def rotation(source: random.Random) -> Numbers:
    """A proper rotation with rational entries, from Cayley's formula in small numbers."""
    w, x, y, z = (Fraction(source.choice([-2, -1, 1, 2])) for _ in range(4))
    p = np.array([x, y, z], dtype=object)
    square = x * x + y * y + z * z
    matrix = np.eye(3, dtype=object) * (w * w - square) + 2 * np.outer(p, p) + 2 * w * skew(p)
    return np.asarray(matrix / (w * w + square))


def arguments_of(model: Model) -> dict[str, int]:
    """Arguments of a model's routines and their lengths."""
    form = model.form
    declared = frames.arguments(model.joint, form.coordinates, form.row_count)
    return {argument.name: argument.length for argument in declared}


def random_inputs(model: Model, seed: int, is_orthonormal: bool = True) -> Inputs:
    """Rational inputs of a model; the rotation matrices exactly orthonormal, or any matrices."""
    source = random.Random(seed)
    inputs = {name: [fraction(source) for _ in range(length)] for name, length in arguments_of(model).items()}
    if is_orthonormal:
        places = [("A_i", 0), ("A_j", 0), ("geometry", 3), ("geometry", 15)]
        for name, offset in places:
            inputs[name][offset : offset + 9] = list(rotation(source).T.ravel())
    if has_unit_quaternions(model.variant):
        inputs["alpha"][-4:] = source.sample([Fraction(1, 5), Fraction(-2, 5), Fraction(2, 5), Fraction(4, 5)], 4)
        velocity = np.array(inputs["velocity"], dtype=object)
        inputs["velocity"] = list(stated_directions(model.variant, inputs) @ velocity)
    return inputs


def stated_directions(variant: Variant, inputs: Inputs) -> Numbers:
    """Projection on the variations for which derivatives are stated: all, or those that keep Euler parameters unit."""
    projection = np.eye(len(inputs["velocity"]), dtype=object) * Fraction(1)
    if has_unit_quaternions(variant):
        projection[-4:, -4:] -= np.outer(inputs["alpha"][-4:], inputs["alpha"][-4:])
    return projection


def of_symbols(model: Model, inputs: Mapping[str, Sequence[Fraction]]) -> dict[str, Any]:
    """Name of every input symbol -> its value: a number, or an array with its row first."""
    values: dict[str, Any] = {"pi": PI}
    for symbol, (name, offset) in frames.inputs(model.form.coordinates, model.form.row_count).items():
        if name not in inputs or offset >= len(inputs[name]):
            continue
        shape = getattr(symbol, "shape", None)
        if shape is None or not shape:
            values[symbol.name] = inputs[name][offset]
            continue
        length = int(shape[0]) * int(shape[1])
        entries = np.array(inputs[name][offset : offset + length], dtype=object)
        values[symbol.name] = entries if shape[1] == 1 else entries.reshape(3, 3).T
    return values | {"r_ij": values["r_j"] - values["r_i"]}
