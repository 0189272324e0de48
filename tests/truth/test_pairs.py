"""Pairs that are a joint of the catalogue: what is found of the joint's routines holds of theirs."""

from __future__ import annotations

from itertools import product

import pytest

from codegen.mechanics.joints import JOINTS, PAIRS
from codegen.models import model
from codegen.spec.request import DERIVATIVES, ROWS, VARIATIONS, Variant
from codegen.spec.selection import incompatibilities
from tests.reference.constraints import CATALOGUE_PAIRS

OPTIONS = tuple(product(ROWS, DERIVATIVES, VARIATIONS))


@pytest.mark.parametrize(("pair", "joint"), CATALOGUE_PAIRS.items())
def test_a_pair_of_the_catalogue_is_formulated_as_the_joint(pair: str, joint: str) -> None:
    compared = 0
    for options in OPTIONS:
        one, other = (Variant(name, "parametric", *options) for name in (pair, joint))
        refused = bool(incompatibilities(PAIRS[pair], one))
        assert refused == bool(incompatibilities(JOINTS[joint], other))
        if not refused:
            assert model(one).form == model(other).form, options
            compared += 1
    assert compared >= 6


def test_another_option_is_another_formulation() -> None:
    forms = [model(Variant("revolute", "parametric", "regular", derivative)).form for derivative in DERIVATIVES]
    assert forms[0] != forms[1]
