"""The C of a scene: silent under every compiler, clean under sanitizers, without arithmetic that does nothing."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from flopcount.count_c import count_c
from tests.c.packages import compile_silently, have
from tests.c.test_compiles import CPP
from tests.c.test_sanitizers import FLAGS, driver

from .packages import STRICT, Package, package

pytestmark = pytest.mark.skipif(not have("gcc"), reason="needs gcc")
REALS = ("-DJG_REAL_IS_DOUBLE", "-DJG_REAL_IS_FLOAT")


@pytest.mark.parametrize("compiler", ["gcc", "clang"])
@pytest.mark.parametrize("real", REALS)
def test_the_source_compiles_silently_in_both_number_types(made: Package, compiler: str, real: str) -> None:
    if not have(compiler):
        pytest.skip(f"needs {compiler}")
    compile_silently([compiler, *STRICT, real, "-O1", "-c", str(made.source), "-o", "/dev/null"])


def test_the_header_compiles_as_cpp_twice(made: Package) -> None:
    if not have("g++"):
        pytest.skip("needs g++")
    include = f'#include "{made.name}.h"\n'
    compile_silently(["g++", *CPP, f"-I{made.root}", "-fsyntax-only", "-xc++", "-"], 2 * include)


def test_externals_compile_silently_where_numbers_are_double(made: Package) -> None:
    external = made.root / "casadi/external.c"
    assert external.exists() == (made.case.real == "double")
    if external.exists():
        compile_silently(["gcc", *STRICT, f"-I{made.root}", "-O0", "-c", str(external), "-o", "/dev/null"])


def test_every_routine_runs_clean_under_sanitizers(made: Package, tmp_path: Path) -> None:
    text = driver(made.entries).replace("jointgen/jointgen.h", f"{made.name}.h")
    (tmp_path / "driver.c").write_text(text)
    sources = [str(tmp_path / "driver.c"), str(made.source)]
    try:
        compile_silently(["gcc", *FLAGS, f"-I{made.root}", *sources, "-lm", "-o", str(tmp_path / "driver")])
    except AssertionError as error:
        if "cannot find" in str(error):
            pytest.skip("gcc has no sanitizers here")
        raise
    run = subprocess.run([tmp_path / "driver"], capture_output=True, text=True, check=False)
    assert (run.returncode, run.stderr, run.stdout) == (0, "", f"{len(made.entries)}\n")


def test_the_example_runs_and_shows_that_the_joints_are_closed(made: Package, tmp_path: Path) -> None:
    source = made.root / f"{made.name}_example.c"
    target = str(tmp_path / "example")
    compile_silently(["gcc", *STRICT, f"-I{made.root}", str(source), str(made.source), "-lm", "-o", target])
    printed = subprocess.run([target], capture_output=True, text=True, check=True).stdout
    numbers = re.findall(r"^(\w+)\[[\d, ]+\] = (\S+)$", printed, re.MULTILINE)
    assert len(numbers) == len(printed.splitlines()) > 0
    closed = 1e-6 if made.case.real == "float" else 1e-12
    assert all(abs(float(value)) < closed for name, value in numbers if name == "phi")


def statements(made: Package) -> Iterator[str]:
    """Statements of all routines, without comments."""
    text = re.sub(r"/\*.*?\*/", "", made.source.read_text(), flags=re.DOTALL)
    for body in re.findall(r"^\{\n(.*?)^\}", text, re.MULTILINE | re.DOTALL):
        yield from (" ".join(statement.split()) for statement in body.split(";"))


def test_nothing_is_multiplied_by_1_or_added_to_0(made: Package) -> None:
    """Identities and permutations of axes are no arithmetic."""
    zero, one = r"JG_REAL\(-?0\.0\)", r"JG_REAL\(-?1\.0\)"
    idle = re.compile(rf"[-+*] {zero}|{zero} [-+*/]|[*/] {one}|{one} \*")
    for statement in statements(made):
        assert not idle.search(statement), statement


CONVENTIONAL = ("engine", "engine in the plane", "spatial slider-crank", "Bricard")


@pytest.mark.parametrize("name", CONVENTIONAL)
def test_conventional_joints_need_no_trigonometry(name: str, scene_packages: Path) -> None:
    made = package(name, scene_packages)
    for entry in made.entries:
        assert entry["output"] in ("residual", "jacobian") or not any(
            entry["operations"][kind] for kind in ("sincos", "sin", "cos", "atan2")
        )
    with_angles = "residual" in made.case.quantities
    assert with_angles or not re.search(r"jg_(sin|cos|sincos|atan2)\(", made.source.read_text())


def test_both_counters_of_operations_agree(made: Package) -> None:
    counted = count_c(made.source.read_text())
    for entry in made.entries:
        if entry["storage"] != "dense":
            assert counted[entry["symbol"]].as_dict() == entry["operations"], entry["symbol"]
