"""The quantities of a platform as a program: pose in, velocity indices out (S3).

``ldot = J (v, w)``: J maps the motion of the platform to that of the legs, so that a large D is slow and stiff.

- ``lengths`` [6] |l_i|; ``J`` [6, 6] with rows ``(e_i, p_i x e_i)``; ``det`` |det J|
- ``D`` [4], ``C`` [4] of sigma, beta, alpha, gamma: product of the three values, greatest over least
- ``values`` [12], ``semi_axes`` [12] sigma, beta, alpha, gamma in descending order, and their reciprocals
- ``ellipsoids`` [3, 12] factors F of the four ellipsoids ``{F u: |u| <= 1}``
- ``Q1``, ``Q2`` [6, 3] with ``J^-1 = [Q1'; Q2']``
- ``w_of_v`` [3, 3], ``v_of_w`` [3, 3] accompanying motions: ``w = w_of_v v`` where v is extremal (Eqs. 37, 38)
- ``limits`` [6] greatest components of v and w for leg speeds of at most 1: absolute sums of the rows of J^-1
- ``dD``, ``dC`` [4, 42] gradients by o (3), a turn about axes of the base (3), B_i (18) and p'_i (18); of C with the
  vectors held fixed where values are equal
- ``status`` 1, 2, 4: J1, J2, J without full rank; 8: no number (a leg of length zero, input that is not finite)
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import sympy

from codegen.errors import InternalError
from codegen.ir.lower.staged import Stages
from codegen.ir.program import Program
from codegen.mechanics.velocity.blocks import Blocks, blocks
from codegen.mechanics.velocity.geometry import Legs, legs
from codegen.mechanics.velocity.gradients import gradients
from codegen.mechanics.velocity.gram import gram_spectra, not_negative, textbook
from codegen.mechanics.velocity.inverse import accompanying, ellipsoids, inverse_jacobian
from codegen.mechanics.velocity.rank import Judged, judged
from codegen.mechanics.velocity.spectra import Spectrum, balanced, frobenius, robust
from codegen.mechanics.velocity.volumes import volumes
from codegen.spec.platform import Platform

BLOCKS = ("sigma", "beta", "alpha", "gamma")
"""The blocks in the order of all outputs; the last two have the unit of a length."""

EPS = {"double": Fraction(1, 2**52), "float": Fraction(1, 2**23)}

_ROUNDING = 16
"""A value below so many eps of the greatest is rounding: the pose is singular."""


def velocity_program(
    platform: Platform, names: tuple[str, ...], real: str = "double", is_symbolic: bool = False
) -> Program:
    """Derive quantities of a platform; the program is not simplified.

    Args:
        platform: its joints, and in ``wanted`` the variant and how the attitude is taken.
        names: of the quantities that the variant offers.
        real: number type, which decides what is rounding.
        is_symbolic: whether the joints are arguments too.
    """
    stages = Stages(is_paired=True)
    found = legs(stages, platform, is_symbolic)
    model = _Model(stages, platform, found, limits(platform, found.exponent, real))
    for name, value in model.quantities(names).items():
        stages.output(name, value)
    return stages.program()


def limits(platform: Platform, exponent: int, real: str) -> tuple[sympy.Rational, sympy.Rational]:
    """Sizes of values of J1 and of J2 that are rounding, the latter in the length unit.

    No column of J1 is longer than sqrt 6, none of J2 than sqrt 6 times the greatest distance of a joint.
    """
    size = max(sum(abs(x) for x in joint) for joint in platform.joints)
    bits = max(0, size.numerator.bit_length() - size.denominator.bit_length()) if size >= 1 else 0
    bits = bits or -max(0, size.denominator.bit_length() - size.numerator.bit_length())
    rounding = sympy.Rational(2 * _ROUNDING * EPS[real].numerator, EPS[real].denominator)
    return rounding, rounding * sympy.Integer(2) ** (bits - exponent)


@dataclass
class _Model:
    stages: Stages
    platform: Platform
    legs: Legs
    limits: tuple[sympy.Rational, sympy.Rational]

    def quantities(self, names: tuple[str, ...]) -> dict[str, sympy.Matrix]:
        """The matrices of the named quantities, in m."""
        unit = sympy.Integer(2) ** self.legs.exponent
        found: dict[str, sympy.Matrix] = {}
        if {"lengths", "J"} & set(names):
            found["lengths"] = self.legs.lengths * unit
            found["J"] = sympy.Matrix.hstack(self.legs.J1, self.legs.J2 * unit)
        variant = self.platform.wanted.variant
        if set(names) - {"lengths", "J"}:
            if variant in ("robust", "balanced"):
                found |= self._factored(names, robust if variant == "robust" else balanced, unit)
            else:
                found |= self._indices(self._cheap(variant), unit)
        missing = [name for name in names if name not in found]
        if missing:
            raise InternalError(f"the variant {variant} has no {missing}")
        return {name: found[name] for name in names}

    def _cheap(self, variant: str) -> dict[str, Spectrum]:
        if variant == "values":
            return volumes(self.stages, self.legs, self.limits)
        if variant == "smooth":
            found = blocks(self.stages, self.legs, self.limits, are_values_judged=True)
            return {name: frobenius(self.stages, getattr(found, name)) for name in BLOCKS}
        return gram_spectra(self.stages, self.legs, not_negative if variant == "fast" else textbook)

    def _factored(self, names: tuple[str, ...], spectrum: object, unit: sympy.Expr) -> dict[str, sympy.Matrix]:
        found = blocks(self.stages, self.legs, self.limits, bool({"Q1", "Q2", "limits"} & set(names)))
        result: dict[str, sympy.Matrix] = {}
        if {"Q1", "Q2", "limits"} & set(names):
            result |= inverse_jacobian(self.stages, found, unit)
        if {"w_of_v", "v_of_w"} & set(names):
            result |= accompanying(self.stages, found, unit)
        if "ellipsoids" in names:
            result["ellipsoids"] = ellipsoids(found, unit)
        if {"D", "C", "values", "semi_axes", "det", "status", "dD", "dC"} & set(names):
            of = {"beta": self.limits[0], "sigma": self.limits[0], "alpha": self.limits[1], "gamma": self.limits[1]}
            spectra = {name: spectrum(self.stages, getattr(found, name), of[name]) for name in BLOCKS}  # type: ignore[operator]
            rank: Judged = judged(self.stages, spectra)
            result |= self._indices(rank.spectra, unit)
            result["status"] = rank.status
            result |= self._gradients(names, found, rank.spectra, unit)
        return result

    def _gradients(
        self, names: tuple[str, ...], found: Blocks, spectra: dict[str, Spectrum], unit: sympy.Expr
    ) -> dict[str, sympy.Matrix]:
        """Gradients by lengths in m and turns in rad."""
        indices = {}
        if "dD" in names:
            indices["D"] = [
                spectra[name].D * unit**3 if name in ("alpha", "gamma") else spectra[name].D for name in BLOCKS
            ]
        if "dC" in names:
            indices["C"] = [spectra[name].C for name in BLOCKS]
        if not indices:
            return {}
        scale = sympy.diag(*[1 / unit] * 3, *[1] * 3, *[1 / unit] * 36)
        return {name: M * scale for name, M in gradients(self.stages, self.legs, found, indices).items()}

    def _indices(self, spectra: dict[str, Spectrum], unit: sympy.Expr) -> dict[str, sympy.Matrix]:
        scale = {"sigma": sympy.Integer(1), "beta": sympy.Integer(1), "alpha": unit, "gamma": unit}
        D = sympy.Matrix([spectra[name].D * scale[name] ** 3 for name in BLOCKS])
        found = {"D": D, "det": sympy.Matrix([spectra["sigma"].D * spectra["gamma"].D * unit**3])}
        values = [value * scale[name] for name in BLOCKS for value in spectra[name].values]
        if values:
            found["values"] = sympy.Matrix(values)
            found["semi_axes"] = sympy.Matrix([1 / value for value in values])
        conditions = [spectra[name].C for name in BLOCKS]
        if None not in conditions:
            found["C"] = sympy.Matrix(conditions)
        return found
