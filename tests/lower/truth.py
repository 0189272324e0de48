"""The reference of `tests.reference` in exact fractions, with the stand-ins of `numbers` for functions of an angle."""

from __future__ import annotations

import operator
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np
from flint import fmpq

from codegen.spec.request import Variant
from tests.reference.constraints import phi, unpack_geometry
from tests.reference.derivatives import gamma_from_tensors, pose_of, tensors
from tests.truth.cases import true_screw

from .numbers import PI, Inputs, Numbers, arc_tangent, cosine, sine


class Exact:
    """A rational number with the functions the reference asks a number type for; the arithmetic is FLINT's."""

    __slots__ = ("value",)

    def __init__(self, value: Any) -> None:
        if not isinstance(value, fmpq):
            exact = Fraction(value)
            value = fmpq(exact.numerator, exact.denominator)
        self.value = value

    def fraction(self) -> Fraction:
        return Fraction(int(self.value.p), int(self.value.q))

    def sin(self) -> Exact:
        return Exact(sine(self.fraction()))

    def cos(self) -> Exact:
        return Exact(cosine(self.fraction()))

    def atan2(self, x: Exact) -> Exact:
        return Exact(arc_tangent(self.fraction(), x.fraction()))

    @staticmethod
    def pi() -> Exact:
        return Exact(PI)

    def __neg__(self) -> Exact:
        return Exact(-self.value)


def _closed(operation: Callable[[Any, Any], Any]) -> Callable[[Exact, Any], Any]:
    def closed(self: Exact, other: Any) -> Any:
        if isinstance(other, Exact):
            return Exact(operation(self.value, other.value))
        return Exact(operation(self.value, other)) if isinstance(other, int) else NotImplemented

    return closed


def _reversed(operation: Callable[[Any, Any], Any]) -> Callable[[Exact, Any], Any]:
    return lambda self, other: Exact(operation(other, self.value)) if isinstance(other, int) else NotImplemented


for _name in ("add", "sub", "mul", "truediv"):
    setattr(Exact, f"__{_name}__", _closed(getattr(operator, _name)))
    setattr(Exact, f"__r{_name}__", _reversed(getattr(operator, _name)))


def exact_truth(variant: Variant, inputs: Inputs) -> dict[str, Numbers]:
    """True value of every quantity and product, dense, from `tests.reference`."""
    values: dict[str, Any] = {
        name: np.array([Exact(entry) for entry in entries], dtype=object) for name, entries in inputs.items()
    }
    values |= {name: values[name].reshape(3, 3).T for name in ("A_i", "A_j")}
    pose, geometry = pose_of(values), unpack_geometry(values["geometry"])
    derivative = variant.derivative if variant.form == "parametric" else "exact"
    options: dict[str, Any] = {"derivative": derivative, "variation": variant.variation, "screw": true_screw(variant)}
    first, second = tensors(variant.joint, variant.form, variant.rows, pose, geometry, **options)
    v = values["velocity"]
    found = {
        "phi": phi(variant.joint, variant.form, variant.rows, pose, geometry),
        "phi_q": first,
        "phi_q_t_lambda_q": np.tensordot(values["lambda"], second, axes=(0, 0)).T,
        "gamma": gamma_from_tensors(first, second, v, variant.form, variant.variation),
        "phi_q_v": first @ v,
        "phi_q_t_lambda": first.T @ values["lambda"],
    }
    return {name: np.vectorize(_fraction, otypes=[object])(value) for name, value in found.items()}


def _fraction(entry: Any) -> Fraction:
    return entry.fraction() if isinstance(entry, Exact) else Fraction(entry)
