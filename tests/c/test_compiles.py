"""Everything generated compiles silently: C99 by the flags of DESIGN 3.2 in both number types, headers as C++17 too."""

from __future__ import annotations

import re
import subprocess

import pytest

from tests.harness.library import HarnessError

from .packages import DOUBLE, FLOAT, NATIVE, STRICT, Package, compile_silently, have

pytestmark = pytest.mark.skipif(not have("gcc"), reason="needs gcc")
CPP = ("-std=c++17", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Wdouble-promotion", "-Werror")
needs_cpp = pytest.mark.skipif(not have("g++"), reason="needs g++")


def test_sources_compile_silently_in_the_number_type_they_are_for(generated: Package) -> None:
    generated.objects(*STRICT, *NATIVE)


def test_sources_compile_silently_in_the_other_number_type(generated: Package) -> None:
    generated.parse(*STRICT, *(FLOAT if generated.real == "double" else DOUBLE))


def test_externals_of_casadi_compile_silently_and_are_double_only(generated: Package) -> None:
    compiled = generated.objects(*STRICT, "-O0", "-fPIC", externals=True)
    assert bool(compiled) == (generated.real == "double")


def test_the_flags_do_find_what_they_are_for() -> None:
    for wrong in ("void f(void) { }", "static float g(double x) { return x; }\nfloat h(void) { return g(1.0); }"):
        with pytest.raises(HarnessError, match="-Werror="):
            compile_silently(["gcc", *STRICT, "-fsyntax-only", "-xc", "-"], wrong)


@pytest.mark.parametrize("choice", [NATIVE, FLOAT, DOUBLE], ids=["native", "float", "double"])
@pytest.mark.parametrize(("compiler", "flags"), [("gcc", STRICT), pytest.param("g++", CPP, marks=needs_cpp)])
def test_each_header_compiles_alone_and_twice(
    generated: Package, compiler: str, flags: tuple[str, ...], choice: tuple[str, ...]
) -> None:
    language = "c" if compiler == "gcc" else "c++"
    include = f"-I{generated.root / 'c/include'}"
    headers = generated.headers if choice == NATIVE else generated.headers[-1:]
    for header in headers:
        text = f'#include "jointgen/{header.name}"\n#include "jointgen/{header.name}"\nextern int used;\n'
        compile_silently([compiler, *flags, *choice, include, "-fsyntax-only", f"-x{language}", "-"], text)


@pytest.mark.parametrize("flag", ["-ffast-math", "-Ofast", "-D__FAST_MATH__"])
def test_fast_math_is_refused_with_a_reason(generated: Package, flag: str) -> None:
    for path in (generated.headers[-1], generated.sources[0]):
        command = ["gcc", "-std=c99", flag, f"-I{generated.root / 'c/include'}", "-fsyntax-only", "-xc", str(path)]
        run = subprocess.run(command, capture_output=True, text=True, check=False)
        assert run.returncode != 0
        assert re.search(r"#error .*must not be compiled with -ffast-math: it \w+", run.stderr), run.stderr


def test_math_h_is_all_that_is_included(generated: Package) -> None:
    allowed = {"<math.h>", '"jg_real.h"'} | {f'"jointgen/{h.name}"' for h in generated.headers}
    allowed |= {f'"{h.name}"' for h in (generated.root / "c/include/jointgen").iterdir()}
    for path in (*generated.sources, *generated.headers):
        included = set(re.findall(r"^\s*#\s*include\s+(\S+)", path.read_text(), re.MULTILINE))
        assert included <= allowed, path
