"""Prescribed motions: values and derivatives, and tables that cannot be used."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction as F

import numpy as np
import pytest

from codegen.chains.motion import function, motions
from codegen.errors import SpecificationError
from codegen.spec.chain import Chain
from codegen.spec.chain_motions import Harmonic, Independent, Motion, Polynomial, Table

from .mechanisms import quick_return

T = np.linspace(0.0, 2.0, 41)
SINE = "t,q\n" + "\n".join(f"{t:.17g},{np.sin(3 * t):.17g}" for t in T)
MOTIONS: dict[str, tuple[Motion, dict[str, str]]] = {
    "polynomial": (Polynomial((F(1), F(-2), F("0.5"), F(3))), {}),
    "constant": (Polynomial((F(7),)), {}),
    "harmonic": (Harmonic(F("0.2"), F("1.5"), F(3), F("0.4")), {}),
    "harmonic that goes on": (Harmonic(F("0.2"), F("1.5"), F(3), F("0.4"), F("0.6")), {}),
    "table": (Table("sine.csv"), {"sine.csv": SINE}),
    "two points": (Table("line.csv"), {"line.csv": "0,1\n2,5\n"}),
    "three points": (Table("line.csv"), {"line.csv": "0,1\n1,3\n2,5\n"}),
}


def driven(motion: Motion | None) -> Chain:
    return replace(quick_return(), independents=(Independent("crank", motion),))


@pytest.mark.parametrize("name", MOTIONS)
def test_rates_are_difference_quotients(name: str) -> None:
    motion, tables = MOTIONS[name]
    at, h = function(motion, tables), 1e-4
    for t in (0.3, 0.77, 1.5):
        if name == "three points":
            t = t / 2
        before, here, after = at(t - h), at(t), at(t + h)
        assert (after[0] - before[0]) / (2 * h) == pytest.approx(here[1], abs=1e-5)
        assert (after[1] - before[1]) / (2 * h) == pytest.approx(here[2], abs=1e-4)


def test_a_polynomial_has_its_values() -> None:
    assert function(MOTIONS["polynomial"][0], {})(2.0) == pytest.approx((1 - 4 + 2 + 24, -2 + 2 + 36, 1 + 36))


def test_a_harmonic_has_its_values() -> None:
    value, _, _ = function(MOTIONS["harmonic that goes on"][0], {})(2.0)
    assert value == pytest.approx(0.2 + 0.6 * 2.0 + 1.5 * np.sin(3 * 2.0 + 0.4))


def test_a_table_of_a_sine_is_a_sine_with_its_acceleration() -> None:
    at = function(Table("sine.csv"), {"sine.csv": SINE})
    for t in np.linspace(0.0, 2.0, 33):
        q, qd, qdd = at(float(t))
        assert q == pytest.approx(np.sin(3 * t), abs=1e-6)
        assert qd == pytest.approx(3 * np.cos(3 * t), abs=1e-4)
        assert qdd == pytest.approx(-9 * np.sin(3 * t), abs=1e-2)


def test_a_table_goes_through_its_points() -> None:
    at = function(Table("sine.csv"), {"sine.csv": SINE})
    assert [at(float(t))[0] for t in T] == pytest.approx(np.sin(3 * T), abs=1e-14)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("0,1\n1,x\n", "line 2 is not two numbers"),
        ("0,1\n1,2,3\n", "line 2 is not two numbers"),
        ("0,1\n1,inf\n", "line 2 is not two numbers"),
        ("0,1\n", "has 1 points"),
        ("", "has 0 points"),
        ("0,1\n2,2\n1,3\n", "times do not grow"),
        ("0,1\n0.5,2\n", "covers 0 s to 0.5 s, and the run takes 0 to 1 s"),
        ("0.5,1\n2,2\n", "covers 0.5 s to 2 s"),
    ],
)
def test_tables_that_cannot_be_used_are_told(text: str, told: str) -> None:
    with pytest.raises(SpecificationError, match=told):
        motions(driven(Table("t.csv")), {"t.csv": text}, 1.0)


def test_a_coordinate_without_a_motion_is_told() -> None:
    with pytest.raises(SpecificationError, match='independent coordinate "crank": has no motion'):
        motions(driven(None), {}, 1.0)
