"""The example of a user: include a header, call a routine, print a Jacobian; in C and in C++."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from .packages import STRICT, Package, compile_silently, have, package

pytestmark = pytest.mark.skipif(not have("gcc"), reason="needs gcc")
README = Path(__file__).resolve().parents[2] / "README.md"

EXAMPLE = """
#include <stdio.h>
#include "jointgen/revolute.h"

int main(void)
{
    const jg_real A_i[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    const jg_real A_j[9] = {0, 1, 0, -1, 0, 0, 0, 0, 1}; /* a quarter turn about z */
    const jg_real geometry[24] = {1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    jg_real phi_q[5 * 12];
    jg_revolute_conventional_phi_q_dense(A_i, A_j, geometry, phi_q);
    for (int row = 0; row < 5; ++row) {
        for (int column = 0; column < 12; ++column) {
            printf("%3g", (double)phi_q[5 * column + row] + 0.0);
        }
        printf("\\n");
    }
    return 0;
}
"""

JACOBIAN = [
    [-1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0],
    [0, -1, 0, 0, 0, -1, 0, 1, 0, 0, 0, -2],
    [0, 0, -1, 0, 1, 0, 0, 0, 1, 2, 0, 0],
]
"""The spherical rows [-I, A_i s_i~, I, -A_j s_j~], with s_i = e1 and s_j = 2 e2."""
CPP = ("-std=c++17", "-Wall", "-Wextra", "-Werror")


@pytest.fixture
def library(shared: Path) -> Package:
    return package("revolute", shared)


def run(text: str, library: Package, folder: Path, compiler: str, *flags: str) -> str:
    """Compile the text with the library's objects, run it, give what it prints."""
    target = folder / "example"
    language = "-xc++" if compiler == "g++" else "-xc"
    objects = [str(path) for path in library.objects(*STRICT, "-O1")]
    include = f"-I{library.root / 'c/include'}"
    command = [compiler, *flags, include, language, "-", "-xnone", *objects, "-lm", "-o", str(target)]
    compile_silently(command, text)
    return subprocess.run([target], capture_output=True, text=True, check=True).stdout


@pytest.mark.parametrize(("compiler", "flags"), [("gcc", STRICT), ("g++", CPP)])
def test_a_program_prints_the_jacobian_of_a_hinge(
    library: Package, tmp_path: Path, compiler: str, flags: tuple[str, ...]
) -> None:
    if not have(compiler):
        pytest.skip(f"needs {compiler}")
    lines = run(EXAMPLE, library, tmp_path, compiler, *flags).splitlines()
    printed = [[float(word) for word in line.split()] for line in lines]
    assert printed[:3] == JACOBIAN
    assert [len(row) for row in printed] == [12] * 5
    for row in printed[3:]:
        assert row[:3] == row[6:9] == [0, 0, 0], "perpendicular axes do not see translations"
        assert row[3:5] != [0, 0]
        assert row[5] == row[11] == 0, "the hinge turns freely about its axis"


@pytest.mark.skipif(not README.exists(), reason="there is no README yet")
def test_the_example_of_the_readme_compiles_and_runs(library: Package, tmp_path: Path) -> None:
    blocks = re.findall(r"^```c\n(.*?)^```", README.read_text(), re.MULTILINE | re.DOTALL)
    examples = [block for block in blocks if "#include" in block and "main(" in block]
    assert examples, "the README shows a program"
    for example in examples:
        assert run(example, library, tmp_path, "gcc", "-std=c99", "-Wall", "-Wextra")
