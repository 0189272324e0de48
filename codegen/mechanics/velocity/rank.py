"""Singular poses: values that are rounding become exact zeros, the same in all four blocks, and a mask says which."""

from __future__ import annotations

from dataclasses import dataclass

import sympy

from codegen.ir.lower.staged import Select, Stages
from codegen.mechanics.velocity.spectra import Spectrum
from codegen.mechanics.velocity.triangular import TINY

PARTNERS = {"sigma": "gamma", "gamma": "", "beta": "", "alpha": "beta"}
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
        spectra: of all four blocks, with three values each.
    """
    least = {name: spectrum.values[2] for name, spectrum in spectra.items()}

    def lower(a: str, x: sympy.Expr, y: sympy.Expr) -> sympy.Expr:
        return _stage(stages, a, Select(x, y, x, y), "the lesser")

    any_zero = lower(
        "of_all", lower("of_v", least["sigma"], least["beta"]), lower("of_w", least["alpha"], least["gamma"])
    )
    found = {}
    for name, spectrum in spectra.items():
        last = least[name]
        if PARTNERS[name]:
            if_singular = Select(TINY, least[PARTNERS[name]], 0, last)
            if_singular = _stage(stages, f"if_singular_{name}", if_singular, "least value if J is singular")
            last = _stage(stages, f"{name}_3", Select(any_zero, TINY, if_singular, last), f"least of {name}")
        D = _stage(stages, f"volume_{name}", Select(last, TINY, 0, spectrum.D), f"D of {name}")
        first = _stage(stages, f"{name}_1", Select(spectrum.values[0], TINY, 1, spectrum.values[0]), "not 0")
        C = _stage(stages, f"C_{name}", first / last, "infinite if singular")
        found[name] = Spectrum(D, (spectrum.values[0], spectrum.values[1], last), C)
    bits = [(least["beta"], 1), (least["gamma"], 2), (any_zero, 4)]
    flags = [_stage(stages, f"bit_{bit}", Select(x, TINY, bit, 0), "rank is lacking") for x, bit in bits]
    number = _stage(stages, "bit_8", Select(-1, spectra["beta"].values[0], 0, 8), "8 if there is no number")
    return Judged(found, sympy.Matrix([sum(flags, number)]))


def _stage(stages: Stages, name: str, value: sympy.Expr, words: str) -> sympy.Expr:
    return stages.stage(name, sympy.Matrix([value]), words)[0]
