"""What the manifest tells of batch routines is so; a package without them knows nothing of them."""

from __future__ import annotations

import hashlib
import json
import re
from typing import Any

import pytest

from codegen import build
from codegen.spec.request import Options

SMALL = {"joints": ("screw",), "form": "conventional", "variation": "body", "outputs": ("phi", "phi_q")}


@pytest.fixture(scope="module")
def files() -> dict[str, bytes]:
    return build.generate(Options(**SMALL, batch=8))


@pytest.fixture(scope="module")
def manifest(files: dict[str, bytes]) -> dict[str, Any]:
    document: dict[str, Any] = json.loads(files["manifest.json"])
    return document


def test_the_routines_for_one_joint_are_the_same_with_and_without(files: dict[str, bytes]) -> None:
    alone = build.generate(Options(**SMALL))
    specification = re.compile(rb"specification SHA-256 \w+")
    for path in ("c/src/screw_conventional.c", "c/include/jointgen/screw.h"):
        assert specification.sub(b"", files[path]) == specification.sub(b"", alone[path])
        assert files[path] != alone[path], "another request has another hash"
    assert not [path for path in alone if "batch" in path or "trigonometry" in path or "own" in path]
    assert b"JG_OWN" not in alone["c/include/jointgen/jg_real.h"]
    assert "batch" not in json.loads(alone["manifest.json"])


def test_every_stored_routine_has_its_three_batch_functions(manifest: dict[str, Any]) -> None:
    endings = (("", "aosoa", []), ("_loop", "aosoa", ["count"]), ("_soa", "soa", ["count", "ld"]))
    stored = {f["symbol"]: f for f in manifest["functions"] if f["storage"] != "dense"}
    wanted = {
        f"{symbol}_batch8{ending}": (symbol, layout, counts) for symbol in stored for ending, layout, counts in endings
    }
    batch = manifest["batch"]
    assert batch["lanes"] == 8 and batch["layouts"].keys() == {"aosoa", "soa"}
    assert {f["symbol"]: (f["routine"], f["layout"], f["counts"]) for f in batch["functions"]} == wanted
    for f in batch["functions"]:
        scalar = [(a["name"], a["direction"], a["length"]) for a in stored[f["routine"]]["arguments"]]
        assert [(a["name"], a["direction"], a["length"]) for a in f["arguments"]] == scalar


def test_signatures_and_definitions_are_as_told(files: dict[str, bytes], manifest: dict[str, Any]) -> None:
    qualifier = {"in": "const jg_real *JG_RESTRICT", "out": "jg_real *JG_RESTRICT"}
    for f in manifest["batch"]["functions"]:
        counts = [f"long {name}" for name in f["counts"]]
        arrays = [f"{qualifier[a['direction']]} {a['name']}" for a in f["arguments"]]
        declaration = f"void {f['symbol']}({', '.join(counts + arrays)})"
        for path, end in ((f["header"], ";"), (f["source"], " {")):
            assert declaration + end in re.sub(r"\s+", " ", files[path].decode()), f["symbol"]
        definitions = re.split(r"\n(?=JG_KERNEL )", files[f["source"]].decode())
        assert f["sha256"] in [hashlib.sha256(text.rstrip("\n").encode() + b"\n").hexdigest() for text in definitions]


def test_the_sources_are_built_and_lines_are_no_longer_than_the_house_has_them(files: dict[str, bytes]) -> None:
    assert b"src/screw_conventional_batch8.c" in files["c/CMakeLists.txt"]
    assert b'#include "screw_batch8.h"' in files["c/include/jointgen/jointgen.h"]
    for path, content in files.items():
        if path.startswith("c/"):
            assert max(map(len, content.decode().splitlines())) <= 120, path


def test_generation_is_deterministic(files: dict[str, bytes]) -> None:
    assert build.generate(Options(**SMALL, batch=8)) == files
