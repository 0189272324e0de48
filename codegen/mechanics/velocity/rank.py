"""Singular poses: values that are rounding become exact zeros, the same in all four blocks, and a mask says which."""

from __future__ import annotations

from dataclasses import dataclass

import sympy

from codegen.ir.lower.staged import Select, Stages
from codegen.mechanics.velocity.spectra import Spectrum

_HALF = sympy.Rational(1, 2)

PARTNERS = {"sigma": "gamma", "alpha": "beta"}
"""``|det J| = D_sigma D_gamma = D_beta D_alpha``: where J is singular and gamma (beta) is not, sigma (alpha) is."""


@dataclass(frozen=True)
class Judged:
    """Spectra of a pose that is known to be singular or not.

    Attributes:
        spectra: by name of the block.
        status: [1, 1] sum of 1, 2 and 4 where J1, J2 and J lack rank, 8 where there is no number.
    """

    spectra: dict[str, Spectrum]
    status: sympy.Matrix


def judged(stages: Stages, spectra: dict[str, Spectrum]) -> Judged:
    """Make the blocks agree about the rank of J.

    Args:
        stages: gets the steps.
        spectra: of all four blocks, with values and what is lost.
    """
    lost = {name: spectrum.lost for name, spectrum in spectra.items()}
    count = _stage(stages, "lost_of_all", sum(lost.values(), sympy.Integer(0)), "number of blocks that lost a value")
    flags = dict(lost)
    for name, partner in PARTNERS.items():
        own = _stage(stages, f"own_{name}", lost[name] - lost[partner], f"1, 0 or -1: {name} against {partner}")
        flags[name] = _stage(stages, f"lost_{name}_too", count + 4 * own, f"positive also if J is singular by {name}")
    number = _stage(stages, "bit_8", Select(-1, spectra["beta"].values[0], 0, 8), "8 if there is no number")
    status = lost["beta"] + 2 * lost["gamma"] + Select(count, _HALF, 0, 4) + number
    return Judged(
        {name: _without(stages, name, spectrum, flags[name]) for name, spectrum in spectra.items()},
        sympy.Matrix([status]),
    )


def _without(stages: Stages, name: str, spectrum: Spectrum, lost: sympy.Expr) -> Spectrum:
    """A spectrum of which the least value is 0 where it is lost."""
    first, middle, last = spectrum.values
    last = _stage(stages, f"{name}_3", Select(lost, _HALF, last, 0), f"least of {name}")
    D = _stage(stages, f"volume_{name}", Select(lost, _HALF, spectrum.D, 0), f"D of {name}")
    C = _stage(stages, f"C_{name}", spectrum.C / D, "greatest over least; infinite if singular")
    return Spectrum(D, (first, middle, last), C)


def _stage(stages: Stages, name: str, value: sympy.Expr, words: str) -> sympy.Expr:
    return stages.stage(name, sympy.Matrix([value]), words)[0]
