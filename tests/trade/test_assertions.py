"""In debug builds routines for many joints, and loops over the parts of a scene, assert the domain of each of them."""

from __future__ import annotations

import shutil
import signal
import subprocess
from collections.abc import Mapping
from functools import partial
from pathlib import Path

import pytest

from codegen.build import generate
from codegen.measure.pose_domain import PoseDomain
from codegen.scenes.generate import generate_scene
from codegen.scenes.read import read
from codegen.spec.request import Options
from codegen.trade.domain_checks import joint_check, scene_check
from codegen.trade.scene_domain import scene_domain

pytestmark = pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")

ABORTED = -signal.SIGABRT
WARNINGS = ("-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror")

MANY = """#include <stdlib.h>
#include "jointgen/ball_batch4.h"

/* Joints 0 to 4 of 8 stand at the origin; attitudes and joint frames of the others are zero, and no rotations. */
int main(int argc, char **argv)
{
    static jg_real geometry[24 * 8], r[3 * 8], A[9 * 8], phi[3 * 8];
    const char entry = argv[1][0];
    const long count = argc > 2 ? strtol(argv[2], NULL, 10) : 0;
    for (long joint = 0; joint < 5; ++joint) {
        const long group = joint / 4, lane = joint % 4;
        for (long k = 0; k < 9; k += 4) {
            A[entry == 'a' ? 8 * k + joint : 4 * (9 * group + k) + lane] = JG_REAL(1.0);
            for (long first = k + 3; first < 24; first += 12) {
                geometry[entry == 'a' ? 8 * first + joint : 4 * (24 * group + first) + lane] = JG_REAL(1.0);
            }
        }
    }
    if (entry == 'a') {
        jg_ball_conventional_phi_batch4_soa(count, 8, r, A, r, A, geometry, phi);
    } else if (entry == 'l') {
        jg_ball_conventional_phi_batch4_loop(count, r, A, r, A, geometry, phi);
    } else {
        const long second = entry == 's';
        jg_ball_conventional_phi_batch4(r, A + 36 * second, r, A + 36 * second, geometry + 96 * second, phi);
    }
    return 0;
}
"""

PENDULUM = """
name = "pendulum"
[[body]]
name = "rod"
position = [0.0, -0.5, 0.0]
[[joint]]
name = "pivot"
type = "ball"
bodies = ["ground", "rod"]
point = [0.0, 0.0, 0.0]
[output]
quantities = ["phi"]
"""

THREE = """#include "pendulum.h"

/* Three rods; with an argument the attitude of the last one is zero, and no rotation. */
int main(int argc, char **argv)
{
    static jg_real r[3 * 3], A[9 * 3], phi[3 * 3];
    (void)argv;
    for (int k = 0; k < 27; ++k) {
        A[k] = k % 9 % 4 == 0 && (k < 18 || argc < 2) ? JG_REAL(1.0) : JG_REAL(0.0);
    }
    jg_pendulum_phi(r, A, phi);
    return 0;
}
"""


def written(files: Mapping[str, bytes], folder: Path) -> None:
    for path, content in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(content)


def compiled(folder: Path, *words: str) -> Path:
    subprocess.run(["gcc", *WARNINGS, "-DJG_ASSERT_DOMAIN", *words, "-o", "main", "-lm"], cwd=folder, check=True)
    return folder / "main"


def exit_code(program: Path, *words: str) -> int:
    return subprocess.run([str(program), *words], capture_output=True, check=False).returncode


def test_routines_for_many_joints_assert_the_domain_of_each_and_of_nothing_that_fills_a_group(tmp_path: Path) -> None:
    options = Options(("ball",), "conventional", outputs=("phi",), batch=4)
    written(generate(options, check=partial(joint_check, PoseDomain(), "double")), tmp_path)
    (tmp_path / "main.c").write_text(MANY)
    main = compiled(tmp_path, "main.c", "c/src/ball_conventional_batch4.c", "-Ic/include")
    for entry in ("loop", "arrays"):
        codes = [exit_code(main, entry, str(count)) for count in range(8)]
        assert codes == [0] * 6 + [ABORTED] * 2, entry
    assert exit_code(main, "group") == 0
    assert exit_code(main, "second group") == ABORTED


def test_loops_assert_the_domain_of_all_parts_of_a_scene(tmp_path: Path) -> None:
    (tmp_path / "pendulum.toml").write_text(PENDULUM)
    scene, _ = read(tmp_path / "pendulum.toml", 3)
    written(generate_scene(scene, check=partial(scene_check, scene_domain(scene), "double")), tmp_path)
    assert "for (int k = 0; k < 3; ++k)" in (tmp_path / "pendulum.c").read_text()
    (tmp_path / "main.c").write_text(THREE)
    main = compiled(tmp_path, "main.c", "pendulum.c")
    assert exit_code(main) == 0
    assert exit_code(main, "the last rod is no rotation") == ABORTED
