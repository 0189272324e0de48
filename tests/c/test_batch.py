"""A batch gives, joint by joint, the bits of the routine for one joint, and touches its own memory only."""

from __future__ import annotations

import os
import platform
import subprocess
from pathlib import Path

import numpy as np
import pytest

from codegen.mechanics.joints import JOINTS
from codegen.spec.request import BATCHES, Options
from codegen.spec.selection import library_variants

from .batches import OUTPUTS, SAME_BITS, Routines, batch_package, different_bits
from .packages import DOUBLE, FLOAT, STRICT, compile_silently, have

pytestmark = pytest.mark.skipif(not have("gcc"), reason="needs gcc")
COUNTS = (0, 1, 3, 4, 5, 7, 8)
SCREW = Options(("screw",), derivative="exact", outputs=("phi",), batch=4)
"""Has every function: sine, cosine, their pair, and the arc tangent."""
needs_clang = pytest.mark.skipif(not have("clang"), reason="needs clang")


def differences(routines: Routines, counts: tuple[int, ...]) -> int:
    """Numbers that differ between a batch and one joint after the other, over all batch routines."""
    rng = np.random.default_rng(7)
    found = 0
    for entry in routines.batch:
        for count in counts if entry["counts"] else (routines.lanes,):
            inputs = routines.inputs(routines.scalar[entry["routine"]], count, rng)
            with np.errstate(all="ignore"):
                expected = routines.one_by_one(entry["routine"], inputs, count)
                got = routines.at_once(entry, inputs, count)
            assert expected.keys() == got.keys()
            found += sum(different_bits(expected[name], got[name], routines.word) for name in expected)
    return found


@pytest.mark.parametrize("joint", JOINTS)
def test_every_variant_gives_the_bits_of_the_routine_for_one_joint(joint: str, shared: Path) -> None:
    package = batch_package(shared, Options((joint,), outputs=OUTPUTS, batch=4))
    routines = package.compiled(*SAME_BITS)
    wanted = {variant.stem for variant in library_variants(JOINTS[joint])}
    assert len(routines.batch) == len(wanted) * 3, "three functions a variant"
    assert differences(routines, COUNTS) == 0


@pytest.mark.parametrize(
    ("compiler", "flags"),
    [
        ("gcc", ("-O0",)),
        ("gcc", ("-O2",)),
        ("gcc", ("-O3", "-march=native")),
        ("gcc", ("-O2", "-DJG_NO_VECTORS")),
        pytest.param("clang", ("-O2",), marks=needs_clang),
        pytest.param("clang", ("-O3", "-march=native"), marks=needs_clang),
        pytest.param("clang", ("-O2", "-DJG_NO_VECTORS"), marks=needs_clang),
    ],
    ids=lambda value: value if isinstance(value, str) else " ".join(value),
)
def test_the_bits_hang_on_no_compiler_and_no_flag(compiler: str, flags: tuple[str, ...], shared: Path) -> None:
    routines = batch_package(shared, SCREW).compiled(*SAME_BITS, *flags, compiler=compiler)
    assert differences(routines, COUNTS) == 0


@pytest.mark.parametrize(
    ("compiler", "flags"),
    [
        ("gcc", ("-mfma",)),
        ("gcc", ()),
        ("gcc", ("-O3", "-march=native")),
        ("gcc", ("-mfma", "-DJG_NO_VECTORS")),
        pytest.param("clang", ("-mfma",), marks=needs_clang),
    ],
    ids=lambda value: value if isinstance(value, str) else " ".join(value),
)
@pytest.mark.parametrize(("real", "lanes"), [("double", 4), ("double", 8), ("float", 2), ("float", 4), ("float", 8)])
def test_fused_multiply_adds_give_the_bits_of_one_joint(
    real: str, lanes: int, compiler: str, flags: tuple[str, ...], shared: Path
) -> None:
    if "-mfma" in flags and platform.machine() != "x86_64":
        pytest.skip("needs x86-64")
    options = Options(("screw",), "conventional", variation="body", real=real, outputs=("phi",), batch=lanes, fma=True)
    routines = batch_package(shared, options).compiled(*SAME_BITS, *flags, compiler=compiler)
    assert differences(routines, COUNTS) == 0


def test_prepared_geometry_comes_in_batches_too(shared: Path) -> None:
    options = Options(("screw",), "parametric", "table4", "exact", outputs=OUTPUTS, batch=4, geometry="prepared")
    assert differences(batch_package(shared, options).compiled(*SAME_BITS), COUNTS) == 0


@pytest.mark.parametrize("lanes", BATCHES)
@pytest.mark.parametrize("flags", [(), ("-DJG_NO_VECTORS",)], ids=["vectors", "loops"])
def test_every_size_of_group_in_single_precision(lanes: int, flags: tuple[str, ...], shared: Path) -> None:
    options = Options(("ball",), "parametric", "table4", "exact", real="float", outputs=("phi",), batch=lanes)
    routines = batch_package(shared, options).compiled(*SAME_BITS, *flags)
    assert differences(routines, (*COUNTS, 15, 16, 17, 33)) == 0


def test_where_nothing_is_transcendental_our_own_functions_do_not_matter(shared: Path) -> None:
    package = batch_package(shared, Options(("revolute",), "conventional", outputs=OUTPUTS, batch=4))
    assert differences(package.compiled("-O2", "-fPIC", "-ffp-contract=off"), COUNTS) == 0


def test_a_different_sine_is_found(shared: Path) -> None:
    """The comparison can fail: the mathematical library rounds some sine or arc tangent another way."""
    routines = batch_package(shared, SCREW).compiled("-O2", "-fPIC", "-ffp-contract=off")
    assert differences(routines, (200,)) > 0


@pytest.mark.parametrize("real", [DOUBLE, FLOAT], ids=["double", "float"])
@pytest.mark.parametrize("flags", [(), ("-DJG_NO_VECTORS",), ("-DJG_OWN_TRIGONOMETRY",), ("-mavx2",)], ids=" ".join)
@pytest.mark.parametrize("compiler", ["gcc", pytest.param("clang", marks=needs_clang)])
def test_batch_routines_compile_silently(
    compiler: str, flags: tuple[str, ...], real: tuple[str, ...], shared: Path
) -> None:
    if "-mavx2" in flags and platform.machine() != "x86_64":
        pytest.skip("needs x86-64")
    package = batch_package(shared, SCREW)
    include = f"-I{package.root / 'c/include'}"
    for source in package.sources:
        compile_silently([compiler, *STRICT, *real, *flags, include, "-O1", "-c", str(source), "-o", os.devnull])


@pytest.mark.skipif(not have("g++"), reason="needs g++")
def test_the_headers_of_batches_are_cpp_too(shared: Path) -> None:
    package = batch_package(shared, SCREW)
    flags = ("-std=c++17", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Wdouble-promotion")
    include = f"-I{package.root / 'c/include'}"
    for header in sorted((package.root / "c/include/jointgen").glob("*.h")):
        compile_silently(["g++", *flags, "-Werror", include, "-fsyntax-only", "-xc++", "-"], f'#include "{header}"\n')
    for own in ((), ("-DJG_OWN_TRIGONOMETRY",)):
        text = "".join(f'#include "jointgen/{name}.h"\n' for name in ("screw_batch4", "screw_batch4", "jointgen"))
        compile_silently(["g++", *flags, *own, "-Werror", include, "-fsyntax-only", "-xc++", "-"], text)


DRIVER = """
#include <stdlib.h>
#include "jointgen/jointgen.h"

static jg_real *filled(long length)
{
    jg_real *const array = malloc((size_t)(length > 0 ? length : 1) * sizeof *array);
    if (!array) {
        exit(3);
    }
    for (long k = 0; k < length; ++k) {
        array[k] = (jg_real)(k % 7) - (jg_real)2.5;
    }
    return array;
}

int main(void)
{
    static const long counts[] = {0, 1, 3, 4, 5, 7, 8};
    for (int n = 0; n < 7; ++n) {
        const long count = counts[n];
        for (long ld = count; ld < count + 3; ++ld) {
            CALLS
        }
    }
    return 0;
}
"""


@pytest.mark.parametrize("flags", [(), ("-DJG_NO_VECTORS",)], ids=["vectors", "loops"])
def test_sanitizers_find_nothing(flags: tuple[str, ...], shared: Path, tmp_path: Path) -> None:
    """Each array is an allocation of exactly the length that the layout needs."""
    package = batch_package(shared, Options(("screw",), "parametric", "table4", "exact", outputs=OUTPUTS, batch=4))
    blocks = []
    for entry in package.manifest["batch"]["functions"]:
        names = [f"a_{a['name']}" for a in entry["arguments"]]
        groups = f"{package.lanes} * ((count + {package.lanes - 1}) / {package.lanes})"
        # Of the last entry of an array the joints are there, and nothing up to the leading dimension.
        lengths = {
            "aosoa": "{length} * " + (groups if entry["counts"] else str(package.lanes)),
            "soa": "(count ? ({length} - 1) * ld + count : 0)",
        }
        arrays = [
            f"jg_real *const {name} = filled({lengths[entry['layout']].format(length=a['length'])});"
            for name, a in zip(names, entry["arguments"], strict=True)
        ]
        call = f"{entry['symbol']}({', '.join([*entry['counts'], *names])});"
        blocks.append("{ " + " ".join([*arrays, call, *(f"free({name});" for name in names)]) + " }")
    program = tmp_path / "driver"
    sanitize = ("-std=c99", "-O1", "-fsanitize=address,undefined", "-fno-sanitize-recover=all")
    include = f"-I{package.root / 'c/include'}"
    sources = [str(source) for source in package.sources]
    text = DRIVER.replace("CALLS", "\n            ".join(blocks))
    compile_silently(["gcc", *sanitize, *flags, include, "-xc", "-", *sources, "-lm", "-o", str(program)], text)
    run = subprocess.run([program], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr[:3000]
