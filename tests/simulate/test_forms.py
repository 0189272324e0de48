"""Conventional and parametric, spatial and planar, index 2 and index 1: one motion."""

from __future__ import annotations

import numpy as np
import pytest

from .preparations import example, told

TOLERANCE = 1e-9

REFERENCE = {
    "four_bar": ("planar", "conventional", "exact", 2),
    "spatial_slider_crank": ("spatial", "conventional", "exact", 2),
    "bricard": ("spatial", "conventional", "exact", 2),
}

DURATION = {"four_bar": 0.5, "spatial_slider_crank": 0.5, "bricard": 0.5}

OTHERS = [
    ("four_bar", "planar", "parametric", "exact", 2),
    ("four_bar", "spatial", "conventional", "exact", 2),
    ("four_bar", "planar", "conventional", "exact", 1),
    ("spatial_slider_crank", "spatial", "parametric", "exact", 2),
    ("spatial_slider_crank", "spatial", "parametric", "substituted", 2),
    ("spatial_slider_crank", "spatial", "conventional", "exact", 1),
    ("bricard", "spatial", "parametric", "exact", 2),
]

pytestmark = pytest.mark.slow


@pytest.mark.parametrize(("name", "motion", "form", "derivative", "index"), OTHERS)
def test_forms_agree(name: str, motion: str, form: str, derivative: str, index: int) -> None:
    runs = [
        told(example(name, *how), DURATION[name], TOLERANCE, 50)
        for how in (REFERENCE[name], (motion, form, derivative, index))
    ]
    one, other = (found.trajectory for found in runs)
    limits = {"r": 1e-6, "v": 1e-5, "w": 1e-4, "a": 1e-3, "al": 1e-2}
    found = {word: np.max(np.abs(getattr(one, word) - getattr(other, word))) for word in limits}
    assert {word: error for word, error in found.items() if error > limits[word]} == {}
    # A quaternion and its negative are one attitude.
    assert np.max(1 - np.abs(np.sum(one.q * other.q, axis=-1))) < 1e-12
    assert max(np.max(found.drift) for found in runs) < 1e-8


@pytest.mark.parametrize("name", REFERENCE)
def test_energy_stays_without_dampers(name: str) -> None:
    found = told(example(name, *REFERENCE[name]), DURATION[name], TOLERANCE, 50)
    assert np.ptp(found.energy) < 1e-6
