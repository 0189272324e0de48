"""A driver calls every routine on random and extreme inputs under ASan and UBSan and comes to its end.

Each argument is an allocation of exactly the length of its manifest entry, so that a word too far is a report. The
checks for null and misaligned pointers, which ASan makes as well here, are left out: they double the time to compile.
"""

from __future__ import annotations

import os
import subprocess
from pathlib import Path
from typing import Any

import pytest

from tests.harness.library import HarnessError

from .packages import Package, compile_silently, have

FLAGS = (
    "-std=c99",
    "-O0",
    "-fsanitize=address,undefined",
    "-fno-sanitize=null,alignment",
    "-fno-sanitize-recover=all",
)

PROLOGUE = """
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "jointgen/jointgen.h"

static unsigned long long state = 88172645463325252ULL;

static double uniform(void)
{
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (double)(state >> 11) / 9007199254740992.0;
}

static double value(int kind)
{
    static const double extremes[] = {0.0, -0.0, 1e300, -1e300, 5e-324, -1e-310, INFINITY, -INFINITY, NAN, 1e-200};
    const int count = (int)(sizeof extremes / sizeof *extremes);
    if (kind < count) {
        return extremes[kind];
    }
    if (kind == count) {
        return extremes[(int)(uniform() * count)];
    }
    return kind == count + 1 ? 4.0 * uniform() - 2.0 : 1e6 * (uniform() - 0.5);
}

static jg_real *filled(int length, int kind)
{
    jg_real *const array = malloc(((size_t)length + !length) * sizeof *array);
    if (!array) {
        exit(3);
    }
    for (int k = 0; k < length; ++k) {
        array[k] = (jg_real)value(kind);
    }
    return array;
}
"""


def driver(entries: list[dict[str, Any]]) -> str:
    """C program that calls every function."""
    calls = "\n".join(f"        call_{k}(kind);" for k in range(len(entries)))
    bodies = "\n".join(_call(k, entry) for k, entry in enumerate(entries))
    main = f"int main(void)\n{{\n    for (int kind = 0; kind < 13; ++kind) {{\n{calls}\n    }}\n"
    return f'{PROLOGUE}\n{bodies}\n{main}    printf("%d\\n", {len(entries)});\n    return 0;\n}}\n'


def _call(number: int, entry: dict[str, Any]) -> str:
    names = [argument["name"] for argument in entry["arguments"]]
    lines = [f"    jg_real *const {a['name']} = filled({a['length']}, kind);" for a in entry["arguments"]]
    lines += [f"    {entry['symbol']}({', '.join(names)});"]
    lines += [f"    free({name});" for name in names]
    return f"static void call_{number}(int kind)\n{{\n" + "\n".join(lines) + "\n}\n"


def run(path: Path) -> subprocess.CompletedProcess[str]:
    environment = {
        **os.environ,
        "ASAN_OPTIONS": "detect_stack_use_after_return=1",
        "UBSAN_OPTIONS": "print_stacktrace=1",
    }
    return subprocess.run([path], capture_output=True, text=True, check=False, env=environment)


def build(text: str, folder: Path, *arguments: str) -> Path:
    source, target = folder / "driver.c", folder / "driver"
    source.write_text(text)
    compile_silently(["gcc", *FLAGS, str(source), *arguments, "-lm", "-o", str(target)])
    return target


@pytest.fixture(autouse=True, scope="module")
def sanitizers(tmp_path_factory: pytest.TempPathFactory) -> None:
    if not have("gcc"):
        pytest.skip("needs gcc")
    try:
        build("int main(void) { return 0; }\n", tmp_path_factory.mktemp("probe"))
    except HarnessError:
        pytest.skip("gcc has no sanitizers here")


def test_every_routine_runs_clean(generated: Package, tmp_path: Path) -> None:
    objects = [str(path) for path in generated.objects(*FLAGS)]
    include = f"-I{generated.root / 'c/include'}"
    finished = run(build(driver(generated.entries), tmp_path, include, *objects))
    assert finished.returncode == 0, finished.stderr[:3000]
    assert finished.stderr == ""
    assert finished.stdout == f"{len(generated.entries)}\n"


@pytest.mark.parametrize(
    ("body", "report"),
    [
        ("x[length] = 1.0;", "heap-buffer-overflow"),
        ("static const int pattern[] = {1, 2}; x[0] = pattern[length + 1];", "global-buffer-overflow|out of bounds"),
        ("int n = 2147483647; x[0] = n + length;", "signed integer overflow"),
    ],
)
def test_the_sanitizers_find_what_they_are_for(body: str, report: str, tmp_path: Path) -> None:
    before, after = "double *x = malloc((size_t)length * sizeof *x); (void)a;", "free(x); return 0;"
    text = f"#include <stdlib.h>\nint main(int length, char **a) {{ {before} {body} {after} }}\n"
    finished = run(build(text, tmp_path))
    assert finished.returncode != 0
    assert any(words in finished.stderr for words in report.split("|")), finished.stderr
