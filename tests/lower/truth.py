"""The reference of `tests.reference` in exact fractions, with the stand-ins of `numbers` for functions of an angle."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np

from codegen.spec.request import Variant
from tests.reference.constraints import phi, unpack_geometry
from tests.reference.derivatives import gamma_from_tensors, pose_of, tensors
from tests.truth.cases import true_screw

from .numbers import PI, Inputs, Numbers, arc_tangent, cosine, sine


class Exact(Fraction):
    """A fraction that is closed under arithmetic and has the functions the reference asks a number type for."""

    def sin(self) -> Exact:
        return Exact(sine(self))

    def cos(self) -> Exact:
        return Exact(cosine(self))

    def atan2(self, x: Fraction) -> Exact:
        return Exact(arc_tangent(self, x))

    @staticmethod
    def pi() -> Exact:
        return Exact(PI)


def _closed(operation: Callable[[Any, Any], Any]) -> Callable[[Any, Any], Any]:
    def closed(self: Exact, other: Any) -> Any:
        result = operation(self, other)
        return result if result is NotImplemented else Exact(result)

    return closed


for _name in ("add", "radd", "sub", "rsub", "mul", "rmul", "truediv", "rtruediv"):
    setattr(Exact, f"__{_name}__", _closed(getattr(Fraction, f"__{_name}__")))
Exact.__neg__ = lambda self: Exact(Fraction.__neg__(self))  # type: ignore[method-assign]


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
    return {
        "phi": phi(variant.joint, variant.form, variant.rows, pose, geometry),
        "phi_q": first,
        "phi_q_t_lambda_q": np.tensordot(values["lambda"], second, axes=(0, 0)).T,
        "gamma": gamma_from_tensors(first, second, v, variant.form, variant.variation),
        "phi_q_v": first @ v,
        "phi_q_t_lambda": first.T @ values["lambda"],
    }
