"""A spring and damper between two points, and the derivatives of its force.

With ``d`` from one point to the other and ``l = |d|`` the tension is ``k (l - l0) + c ldot``. The force is that of a
constraint ``d . d / 2`` whose multiplier is ``density`` = tension / l: ``-density w`` with ``w = grad(d . d / 2)``. Its
derivative is ``-density grad w - w slope^T``, where ``slope = grad density`` follows from ``d . d`` and
``d . ddot = l ldot``.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache
from typing import Any

import sympy

from codegen.ir.lower import Block, Dot
from codegen.mechanics import frames
from codegen.mechanics.derivation import is_zero
from codegen.mechanics.formulation import Formulation, formulation
from codegen.mechanics.frames import d_ij
from codegen.mechanics.joints import JOINTS
from codegen.mechanics.placed import rational
from codegen.mechanics.tension import closing, density, drag, square, stiffening, tension
from codegen.mechanics.variation import Variation, coefficient, gradient
from codegen.spec.request import Variant

BALL = Variant("ball", "conventional", None, "exact")
"""A spring joins two points as a ball does: it has the same vector ``d_ij`` and the same motion."""

d_rate = frames.vector("d_rate")
"""``ddot``, m/s, world."""

SLOPES = tuple(frames.vector(f"slope_{k}") for k in range(4))
"""Gradients of ``density``."""


@dataclass(frozen=True)
class SpringLaw:
    """The force of a spring between points of bodies i and j.

    Attributes:
        form: the vector between the points and its motion.
        gradients: ``w``, by displacement.
        virtual: variations by displacements.
    """

    form: Formulation
    gradients: tuple[Any, ...]
    virtual: Variation

    @property
    def whole(self) -> frozenset[Any]:
        """Stages that are vectors and scalars of their own."""
        return frozenset({d_ij, d_rate, density, stiffening, drag, *SLOPES})

    def blocks(self, name: str) -> tuple[Block, ...]:
        """Give the blocks of ``force``, ``force_q`` or ``force_v`` over the displacements of bodies i and j."""
        columns = [column for _, column in self.form.displacements]
        if name == "force":
            return tuple(
                Block(row, 0, sympy.MatMul(-density, w)) for row, w in zip(columns, self.gradients, strict=True)
            )
        found = []
        for n, row in enumerate(columns):
            for k, column in enumerate(columns):
                block = self._by_displacement(n, k) if name == "force_q" else self._by_velocity(n, k)
                if not is_zero(block):
                    found.append(Block(row, column, block))
        return tuple(found)

    def _by_displacement(self, n: int, k: int) -> Any:
        displacement, _ = self.form.displacements[k]
        turning = coefficient(self.virtual.of(self.gradients[n]), displacement, self.form.algebra)
        terms = (
            [sympy.MatMul(-1, self.gradients[n], sympy.Transpose(SLOPES[k]))] if SLOPES[k] in self.form.stages else []
        )
        if not is_zero(turning):
            terms.append(self.form.algebra.normal(sympy.MatMul(-density, turning)))
        return sympy.MatAdd(*terms) if terms else sympy.ZeroMatrix(3, 3)

    def _by_velocity(self, n: int, k: int) -> Any:
        if self.form.stages[drag] == 0:
            return sympy.ZeroMatrix(3, 3)
        return self.form.algebra.normal(sympy.MatMul(-drag, self.gradients[n], sympy.Transpose(self.gradients[k])))


@cache
def spring_law(stiffness: Fraction, damping: Fraction, rest: Fraction, translations: str) -> SpringLaw:
    """Derive the force of a spring.

    Args:
        stiffness: N/m.
        damping: N s/m.
        rest: m, length at which the spring is free.
        translations: axes of the virtual translations, ``world`` or ``body``.
    """
    form = formulation(JOINTS["ball"], BALL, translations)
    algebra, stages = form.algebra, form.stages
    rates = Variation(algebra, stages, form.rates, {})
    virtual = Variation(algebra, stages, form.virtual, {})
    stages = stages | {square: Dot(d_ij, d_ij), d_rate: rates.of(d_ij), closing: Dot(d_ij, d_rate)}
    stages |= tension(*(rational(value) for value in (stiffness, damping, rest)))
    varied, closed = virtual.of(Dot(d_ij, d_ij) / 2), virtual.of(Dot(d_ij, rates.of(d_ij)))
    gradients = []
    for slope, (displacement, _) in zip(SLOPES, form.displacements, strict=True):
        gradients.append(gradient(varied, displacement, algebra))
        terms = [sympy.MatMul(stiffening, gradients[-1])] if stages[stiffening] != 0 else []
        if stages[drag] != 0:
            terms.append(sympy.MatMul(drag, gradient(closed, displacement, algebra)))
        if terms:
            stages[slope] = algebra.normal(sympy.MatAdd(*terms))
    return SpringLaw(replace(form, stages=stages), tuple(gradients), virtual)
