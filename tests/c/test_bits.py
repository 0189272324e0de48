"""Under the documented flags the C gives the bits of the Program at every level of optimisation, with every compiler.

With ``--fma`` too: the fused multiply-adds are those of the Program. The other flags are chosen to tempt the compiler:
GNU C, where it contracts by default, and the machine's own instructions.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen import build, output
from codegen.emit.joint_subject import JointSubject
from codegen.emit.routine import Routine
from codegen.ir.evaluate import evaluate, numpy_domain
from codegen.mechanics.joints import JOINTS
from codegen.spec.request import Options, Variant
from codegen.spec.selection import library_variants
from tests.harness.library import Library, compile_library
from tests.truth.cases import SPOTS, inputs_at

from .packages import STRICT, Package, have, only_one

pytestmark = pytest.mark.skipif(not have("gcc"), reason="needs gcc")
DOCUMENTED = ("-ffp-contract=off", "-fno-tree-slp-vectorize")
LEVELS: tuple[tuple[str, ...], ...] = (("-O0",), ("-O2",), ("-O3", "-march=native"))
COMPILERS = [name for name in ("gcc", "clang") if shutil.which(name)]
BUILDS = [(compiler, ("-std=gnu99", *level, *DOCUMENTED)) for compiler in COMPILERS for level in LEVELS]

both = pytest.mark.parametrize("fma", [False, True], ids=["default", "fma"])


def package(joint: str, fma: bool, shared: Path) -> Path:
    """The fused routines of every library variant of a joint, generated once for all test processes."""
    root = shared / f"bits-{joint}-{fma}"
    with only_one(shared / f"{root.name}.lock"):
        if not root.exists():
            output.replace(root, build.generate(Options((joint,), outputs=("all",), fma=fma)))
    return root


def compiled(root: Path, compiler: str, flags: tuple[str, ...]) -> Library:
    entries = json.loads((root / "manifest.json").read_text())["functions"]
    sources = sorted({entry["source"] for entry in entries})
    return Library(entries, compile_library(root, sources, root.parent / "bits", flags, compiler))


@cache
def routines(joint: str, fma: bool) -> tuple[Routine, ...]:
    return tuple(r for variant in library_variants(JOINTS[joint]) for r in build.routines(variant, ("all",), fma))


def situations(routine: Routine, real: type[Any]) -> Iterator[dict[str, Any]]:
    for spot in SPOTS:
        yield {name: np.asarray(value).astype(real) for name, value in inputs_at(variant_of(routine), spot).items()}


def variant_of(routine: Routine) -> Variant:
    assert isinstance(routine.subject, JointSubject)
    return routine.subject.variant


def bits(values: Any) -> bytes:
    return np.ravel(values, order="F").tobytes()


@both
@pytest.mark.parametrize("joint", JOINTS)
def test_the_bits_are_those_of_the_program(joint: str, fma: bool, shared: Path) -> None:
    libraries = [compiled(package(joint, fma, shared), *build_) for build_ in BUILDS]
    for routine in routines(joint, fma):
        assert bool(routine.counts.fma) == fma
        for inputs in situations(routine, np.float64):
            flat = {name: [float(x) for x in np.ravel(value, order="F")] for name, value in inputs.items()}
            expected = {name: bits(np.float64(values)) for name, values in evaluate(routine.program, flat).items()}
            for library, build_ in zip(libraries, BUILDS, strict=True):
                found = {name: bits(values) for name, values in library.call(routine.symbol, inputs).items()}
                assert found == expected, (routine.symbol, build_)


@both
@pytest.mark.parametrize("joint", ["revolute", "universal", "ball"])
def test_single_precision_has_the_bits_of_the_program_too(joint: str, fma: bool, shared: Path) -> None:
    """Conventional routines, which call no function: sine and cosine of singles are another matter in Python."""
    builds = [(compiler, (*flags, "-DJG_REAL_IS_FLOAT")) for compiler, flags in BUILDS]
    libraries = [compiled(package(joint, fma, shared), *build_) for build_ in builds]
    for library in libraries:
        library.entries = {symbol: {**entry, "real": "float"} for symbol, entry in library.entries.items()}
    for routine in (r for r in routines(joint, fma) if variant_of(r).form == "conventional"):
        for inputs in situations(routine, np.float32):
            flat = {name: list(np.ravel(value, order="F")) for name, value in inputs.items()}
            values = evaluate(routine.program, flat, numpy_domain())
            expected = {name: bits(np.array(entries, dtype=np.float32)) for name, entries in values.items()}
            for library, build_ in zip(libraries, builds, strict=True):
                found = {name: bits(values) for name, values in library.call(routine.symbol, inputs).items()}
                assert found == expected, (routine.symbol, build_)


@pytest.mark.parametrize("real", ["double", "float"])
def test_a_fused_package_compiles_silently_with_its_externals(real: str, shared: Path) -> None:
    root = shared / f"fused-{real}"
    with only_one(shared / f"{root.name}.lock"):
        if not root.exists():
            output.replace(root, build.generate(Options(("screw",), outputs=("phi", "all"), fma=True, real=real)))
    (shared / "objects").mkdir(exist_ok=True)
    fused = Package(root, None, shared / "objects")
    for flags in (("-O1", "-fPIC"), ("-O0", "-DJG_REAL_IS_DOUBLE"), ("-O0", "-DJG_REAL_IS_FLOAT")):
        fused.objects(*STRICT, *flags)
    externals = fused.objects(*STRICT, "-O0", "-fPIC", externals=True)
    assert bool(externals) == (real == "double")
    assert all("jg_fma(" in path.read_text() for path in (*fused.sources, *fused.externals))


@pytest.mark.parametrize("compiler", COMPILERS)
def test_the_flag_is_needed(compiler: str, shared: Path) -> None:
    """A compiler that may contract does, where the processor can: the bits are others then."""
    root = package("revolute", False, shared)
    flags = ("-std=gnu99", "-O2", "-march=native")
    if not processor_fuses():
        pytest.skip("the processor has no fused multiply-add")
    free, held = (compiled(root, compiler, (*flags, f"-ffp-contract={choice}")) for choice in ("fast", "off"))
    (routine, *_) = routines("revolute", False)
    pairs = [(free.call(routine.symbol, x), held.call(routine.symbol, x)) for x in situations(routine, np.float64)]
    assert any(bits(one[name]) != bits(other[name]) for one, other in pairs for name in one)


def processor_fuses() -> bool:
    cpu = Path("/proc/cpuinfo")
    return cpu.exists() and any(word in cpu.read_text().split() for word in ("fma", "asimd"))


def test_the_build_file_and_the_header_tell_of_the_flags(shared: Path) -> None:
    with_fma, without = (package("revolute", fma, shared) for fma in (True, False))
    for name in ("c/CMakeLists.txt", "c/include/jointgen/jg_real.h"):
        words = [" ".join((root / name).read_text().replace("\n *", " ").split()) for root in (with_fma, without)]
        assert [" ".join(DOCUMENTED) in text for text in words] == [True, False], name
    for root, fma in ((with_fma, True), (without, False)):
        manifest = json.loads((root / "manifest.json").read_text())
        assert manifest["fma"] is fma
        assert all(("jg_fma" in (root / entry["source"]).read_text()) is fma for entry in manifest["functions"])
        assert all((entry["operations"]["fma"] > 0) is fma for entry in manifest["functions"])
    hashes = [json.loads((root / "manifest.json").read_text())["specification_sha256"] for root in (with_fma, without)]
    assert hashes[0] != hashes[1]
