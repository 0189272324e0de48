"""Three counts of one routine agree: of its Program, of the emitted C text, and the one its manifest entry carries."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given

from codegen import build, models
from codegen.emit.c import entries
from codegen.emit.joint_subject import JointSubject
from codegen.emit.routine import Routine
from codegen.ir.ops import LEAVES, Op
from codegen.ir.program import Program
from codegen.mechanics.joints import JOINTS, PAIRS
from codegen.passes import simplify
from codegen.spec.request import QUANTITIES, Variant
from codegen.spec.selection import library_variants
from flopcount.count import count
from flopcount.count_c import count_c
from flopcount.counts import Counts
from tests.ir.programs import OPS, RANDOM, programs

GENERATED = Path(__file__).resolve().parents[2] / "generated"
EXTRAS = (
    Variant("ball", "parametric", "quaternion"),
    Variant("ball", "parametric", "quaternion", "substituted"),
    Variant("ball", "parametric", "regular", "exact", "world"),
    Variant("screw", "parametric", "table4", "exact", "world"),
    Variant("screw", "conventional", None, "substituted"),
    Variant("trn3_rot3", "parametric", "table4"),
    Variant("trn2_rot3", "parametric", "quaternion", "exact", "world"),
)


@cache
def manifest() -> dict[str, dict[str, Any]]:
    document = json.loads((GENERATED / "manifest.json").read_text())
    return {function["symbol"]: function for function in document["functions"]}


def symbols_of(routine: Routine) -> Iterator[str]:
    yield routine.symbol
    if routine.is_matrix:
        yield routine.dense_symbol


@pytest.mark.parametrize("joint", JOINTS)
def test_counts_of_the_library_agree_by_kind(joint: str) -> None:
    counted = 0
    for variant in library_variants(JOINTS[joint]):
        source = (GENERATED / f"c/src/{variant.file_stem}.c").read_text()
        in_text = count_c(source)
        for routine in build.routines(variant):
            expected = count(routine.program)
            assert routine.counts == expected, routine.symbol
            for symbol in symbols_of(routine):
                assert in_text.pop(symbol) == expected, symbol
                assert Counts.of(manifest()[symbol]["operations"]) == expected, symbol
                assert manifest()[symbol]["operations"]["total"] == expected.total, symbol
                counted += 1
            _nothing_left_to_simplify(routine)
        assert not in_text, "functions of the text that are no routine"
    assert counted == sum(function["joint"] == joint for function in manifest().values())


def _nothing_left_to_simplify(routine: Routine) -> None:
    again = simplify(routine.program)
    assert count(again) == count(routine.program), routine.symbol
    assert len(again.instructions) == len(routine.program.instructions), routine.symbol


@pytest.mark.parametrize("variant", EXTRAS, ids=lambda variant: variant.file_stem)
def test_counts_of_routines_on_request_agree_by_kind(variant: Variant) -> None:
    for routine in build.routines(variant):
        in_text = count_c("\n".join(entry.text for entry in entries(routine)))
        for symbol in symbols_of(routine):
            assert in_text[symbol] == count(routine.program), symbol


@pytest.mark.parametrize("joint", JOINTS)
def test_counts_of_contracted_routines_agree_by_kind(joint: str) -> None:
    for variant in library_variants(JOINTS[joint]):
        for routine in build.routines(variant, ("all",), True):
            in_text = count_c("\n".join(entry.text for entry in entries(routine)))
            assert routine.counts.fma > 0
            assert [in_text[symbol] for symbol in symbols_of(routine)] == [routine.counts] * 2


@pytest.mark.parametrize("pair", PAIRS)
def test_counts_of_every_pair_agree_by_kind(pair: str) -> None:
    symbolic = models.model(Variant(pair, "parametric", "regular"))
    program = symbolic.program(QUANTITIES)
    routine = Routine(JointSubject(symbolic.joint, symbolic.variant), "all", program, count(program), "")
    assert count_c(entries(routine)[0].text)[routine.symbol] == count(program)


@RANDOM
@given(programs(ops=OPS))
def test_every_operation_is_counted_once_and_leaves_are_free(program: Program) -> None:
    kinds = Counter(i.op for i in program.instructions if i.op not in LEAVES)
    counted = count(program)
    paid = sum(number for op, number in kinds.items() if op not in (Op.NEGATE, Op.ABS))
    assert counted.total == paid + kinds[Op.FMA]
    assert counted.roundings == paid - kinds[Op.SELECT]
    assert counted.add == kinds[Op.ADD] + kinds[Op.SUBTRACT]
    assert (counted.neg, counted.abs, counted.select) == (kinds[Op.NEGATE], kinds[Op.ABS], kinds[Op.SELECT])
    assert counted.fma == kinds[Op.FMA]
    assert counted.arithmetic == counted.add + counted.mul + counted.div + 2 * counted.fma


def test_counts_add_up_and_round_trip() -> None:
    first, second = Counts(add=1, mul=2, sincos=1, neg=4), Counts(add=3, sqrt=1)
    assert first + second == Counts(add=4, mul=2, sincos=1, sqrt=1, neg=4)
    assert Counts.of(first.as_dict()) == first
    assert first.as_dict()["total"] == 4
    assert str(first) == "4 (1 add, 2 mul, 1 sincos, 4 neg)"
    assert str(Counts()) == "0"
