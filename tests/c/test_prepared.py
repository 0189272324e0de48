"""Routines on prepared geometry, in C and CasADi, give the bits of the Programs on run-time geometry."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import casadi
import numpy as np
import pytest

import codegen
from codegen import build, output
from codegen.emit.routine import Routine
from codegen.ir.evaluate import evaluate
from codegen.mechanics.joints import JOINTS
from codegen.spec.request import OUTPUTS, Options, Variant
from codegen.spec.selection import library_variants
from flopcount.count_c import count_c
from flopcount.counts import Counts
from tests.harness.library import Library
from tests.truth.cases import SPOTS, inputs_at

from .packages import STRICT, Package, have, only_one

pytestmark = pytest.mark.skipif(not have("gcc"), reason="needs gcc")
SAME_BITS = ("-ffp-contract=off", "-fno-tree-slp-vectorize")


def package(joint: str, shared: Path) -> Package:
    """The package of a joint on prepared geometry, generated once for all test processes."""
    root = shared / f"prepared-{joint}"
    (shared / "objects").mkdir(exist_ok=True)
    with only_one(shared / f"{root.name}.lock"):
        if not root.exists():
            output.replace(root, build.generate(Options((joint,), geometry="prepared")))
    return Package(root, None, shared / "objects")


def library(prepared: Package) -> Library:
    flags = (*STRICT, "-O2", *SAME_BITS)
    return Library.build(prepared.root / "manifest.json", prepared.root.parent / "bits", flags=flags)


def by_output(entries: list[dict[str, Any]], variant: Variant) -> dict[str, dict[str, Any]]:
    """Entries of a variant that store nonzeros or vectors."""
    fields = ("form", "rows", "derivative", "variation")
    chosen = [e for e in entries if all(e[f] == getattr(variant, f) for f in fields) and e["storage"] != "dense"]
    return {entry["output"]: entry for entry in chosen}


def flat(inputs: dict[str, Any]) -> dict[str, list[float]]:
    return {name: [float(x) for x in np.ravel(value, order="F")] for name, value in inputs.items()}


def values_of(routine: Routine, inputs: dict[str, Any]) -> dict[str, bytes]:
    return {name: np.float64(v).tobytes() for name, v in evaluate(routine.program, flat(inputs)).items()}


@pytest.mark.parametrize("joint", JOINTS)
def test_c_has_the_bits_of_run_time_geometry(joint: str, shared: Path) -> None:
    prepared = package(joint, shared)
    called = library(prepared)
    for variant in library_variants(JOINTS[joint]):
        entries = by_output(prepared.entries, variant)
        assert set(entries) == {"prepare", *OUTPUTS}
        routines = build.routines(variant)
        for spot in SPOTS:
            inputs = inputs_at(variant, spot)
            vector = called.call(entries["prepare"]["symbol"], inputs, canary=True)["prepared"]
            without = {name: value for name, value in inputs.items() if name != "geometry"} | {"prepared": vector}
            for routine in routines:
                symbol = entries[routine.output]["symbol"]
                found = called.call(symbol, without, canary=True)
                there = {name: np.ravel(value, order="F").tobytes() for name, value in found.items()}
                assert there == values_of(routine, inputs), (symbol, spot)


@pytest.mark.parametrize("joint", JOINTS)
def test_everything_compiles_silently_and_no_step_takes_the_geometry(joint: str, shared: Path) -> None:
    prepared = package(joint, shared)
    assert library(prepared).entries
    prepared.parse(*STRICT, "-DJG_REAL_IS_FLOAT")
    assert prepared.objects(*STRICT, "-O0", "-fPIC", externals=True)
    for entry in prepared.entries:
        names = [argument["name"] for argument in entry["arguments"]]
        assert entry["geometry"] == "prepared"
        assert (names == ["geometry", "prepared"]) if entry["output"] == "prepare" else "geometry" not in names


@pytest.mark.parametrize("joint", JOINTS)
def test_the_manifest_tells_both_counts_and_the_layout(joint: str, shared: Path) -> None:
    prepared = package(joint, shared)
    in_text = {name: counts for source in prepared.sources for name, counts in count_c(source.read_text()).items()}
    by_symbol = {entry["symbol"]: entry for entry in prepared.entries}
    header = (prepared.root / prepared.entries[0]["header"]).read_text()
    for entry in prepared.entries:
        assert Counts.of(entry["operations"]) == in_text[entry["symbol"]]
        prepare = by_symbol[entry["prepare"]["symbol"]]
        assert entry["prepare"]["operations"] == prepare["operations"]
        assert f"Prepared by {prepare['symbol']}" in " ".join(header.replace("\n *", " ").split())
        for argument in entry["arguments"]:
            if argument["name"] == "prepared":
                assert argument == {**prepare["arguments"][1], "direction": argument["direction"]}
                assert covered(argument["members"]) == list(range(argument["length"]))


def covered(members: list[dict[str, Any]]) -> list[int]:
    return [m["offset"] + k for m in members for k in range(m["shape"][0] * m["shape"][1])]


@pytest.mark.parametrize("joint", JOINTS)
def test_the_parts_copied_from_the_geometry_are_where_the_layout_says(joint: str, shared: Path) -> None:
    prepared = package(joint, shared)
    called = library(prepared)
    for entry in (entry for entry in prepared.entries if entry["output"] == "prepare"):
        geometry = np.random.default_rng(3).normal(size=entry["arguments"][0]["length"])
        vector = called.call(entry["symbol"], {"geometry": geometry})["prepared"][:, 0]
        raw = {m["name"]: m for m in entry["arguments"][0]["members"]}
        for member in entry["arguments"][1]["members"]:
            name, _, index = member["name"].rpartition("_")
            part = raw.get(member["name"]) or (raw.get(name) if member["name"] not in raw else None)
            if part is None:
                continue
            size = member["shape"][0] * member["shape"][1]
            start = part["offset"] + (0 if member["name"] in raw else int(index))
            assert list(vector[member["offset"] :][:size]) == list(geometry[start : start + size]), member["name"]


def test_the_translational_joint_takes_fifteen_operations_a_step(shared: Path) -> None:
    variant = Variant("translational", "parametric", "regular", "substituted")
    entries = by_output(package("translational", shared).entries, variant)
    assert sum(entries[name]["operations"]["total"] for name in ("phi_q", "phi_q_t_lambda_q")) == 15


def test_casadi_functions_take_what_the_casadi_function_prepares(shared: Path) -> None:
    prepared = package("translational", shared)
    records = json.loads((prepared.root / "manifest.json").read_text())["casadi"]
    chosen = {r["output"]: r for r in records if (r["derivative"], r["form"]) == ("substituted", "parametric")}
    assert set(chosen) == {"prepare", *OUTPUTS}
    variant = Variant("translational", "parametric", "regular", "substituted")
    inputs = inputs_at(variant, SPOTS[0])
    functions = {name: casadi.Function.load(str(prepared.root / r["file"])) for name, r in chosen.items()}
    vector = functions["prepare"](inputs["geometry"])
    for routine in build.routines(variant):
        function = functions[routine.output]
        assert "geometry" not in function.name_in()
        known = {**inputs, "prepared": vector}
        found = function(**{name: known[name] for name in function.name_in()})
        expected = evaluate(routine.program, flat(inputs))
        for name, entries in expected.items():
            assert np.allclose(found[name].nonzeros(), entries, rtol=1e-14, atol=1e-14), (routine.output, name)
    options = {"derivative": "substituted", "geometry": "prepared"}
    for name in ("prepare", "phi_q"):
        built = codegen.casadi_function("translational", "parametric", name, **options)
        assert built.serialize() == functions[name].serialize()


def test_a_request_that_needs_no_geometry_has_nothing_to_prepare() -> None:
    """The substituted second derivative of a rigid joint is zero."""
    request = Options(("rigid",), "parametric", None, "substituted", outputs=("phi_q_t_lambda_q",), geometry="prepared")
    functions = json.loads(build.generate(request)["manifest.json"])["functions"]
    assert {entry["output"] for entry in functions} == {"phi_q_t_lambda_q"}
    assert all("prepare" not in entry for entry in functions)


@pytest.mark.parametrize("joint", ["translational", "screw"])
def test_fused_and_prepared_together_have_the_bits_of_fused_alone(joint: str, shared: Path) -> None:
    root = shared / f"prepared-fma-{joint}"
    with only_one(shared / f"{root.name}.lock"):
        if not root.exists():
            output.replace(root, build.generate(Options((joint,), outputs=("all",), fma=True, geometry="prepared")))
    prepared = Package(root, None, shared / "objects")
    called = library(prepared)
    for variant in library_variants(JOINTS[joint]):
        entries = by_output(prepared.entries, variant)
        (routine,) = build.routines(variant, ("all",), True)
        for spot in SPOTS:
            inputs = inputs_at(variant, spot)
            vector = called.call(entries["prepare"]["symbol"], inputs)["prepared"]
            found = called.call(entries["all"]["symbol"], {**inputs, "prepared": vector})
            there = {name: np.ravel(value, order="F").tobytes() for name, value in found.items()}
            assert there == values_of(routine, inputs), (variant.stem, spot)
