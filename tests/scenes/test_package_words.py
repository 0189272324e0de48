"""What the manifest and the README say of a scene is so."""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path

import numpy as np

from codegen.scenes.numbers import constraint_system
from codegen.spec.scene import COORDINATE_UNITS

from .packages import Package, package


def arguments(made: Package) -> dict[str, dict]:
    return {a["name"]: a for e in made.entries for a in e["arguments"]}


def test_parts_follow_one_another_and_fill_their_array(made: Package) -> None:
    for name, argument in arguments(made).items():
        parts = argument.get("members", [])
        ends = [0]
        for part in parts:
            assert part["offset"] == ends[-1], (name, part)
            ends.append(part["offset"] + part["shape"][0] * part["shape"][1])
        assert not parts or ends[-1] == argument["length"], name


def test_no_name_is_used_twice_in_a_function(made: Package) -> None:
    for entry in made.entries:
        names = [a["name"] for a in entry["arguments"]]
        names += [part["name"] for a in entry["arguments"] for part in a.get("members", [])]
        assert len(set(names)) == len(names)


def test_rows_displacements_and_state_are_as_many_as_the_arrays_have(made: Package) -> None:
    scene, arrays = made.manifest["scene"], arguments(made)
    sizes = {"rows": len(scene["rows"]), "state": len(scene["state"])}
    sizes["displacements"] = sum(part["size"] for part in scene["displacements"])
    expected = {
        "phi": [sizes["rows"], 1],
        "phi_q": [sizes["rows"], sizes["displacements"]],
        "phi_q_t_lambda_q": [sizes["displacements"]] * 2,
        "lambda": [sizes["rows"], 1],
        "velocity": [sizes["displacements"], 1],
        "y": [sizes["state"], 1],
        "residual": [sizes["state"], 1],
        "jacobian": [sizes["state"]] * 2,
    }
    for name, shape in expected.items():
        assert name not in arrays or arrays[name]["shape"] == shape, name


def test_joints_have_their_coordinates_in_alpha(made: Package) -> None:
    alpha = arguments(made).get("alpha")
    parametric = [j for j in made.manifest["scene"]["joints"] if j["form"] == "parametric"]
    expected = {f"alpha_{j['identifier']}": len(COORDINATE_UNITS[j["type"]]) for j in parametric}
    expected = {name: size for name, size in expected.items() if size}
    told = alpha["members"] if alpha else []
    if told or made.case.form == "parametric":
        assert {part["name"]: part["shape"][0] for part in told} == expected


def table(made: Package, heading: str) -> list[list[str]]:
    section = made.readme.split(f"## {heading}\n")[1].split("\n## ")[0]
    lines = [line for line in section.splitlines() if line.startswith("|")][2:]
    return [[cell.strip().replace("\\", "").strip("`") for cell in line.strip("|").split(" | ")] for line in lines]


def spread_out(words: str) -> list[str]:
    """Rows of a joint one by one: ``x, y of the point`` are two."""
    found: list[str] = []
    for word in reversed([] if words == "none" else words.split(", ")):
        component, _, vector = word.partition(" of ")
        if not vector and component in "xyz" and found:
            vector = found[-1].partition(" of ")[2]
            word = f"{component} of {vector}"
        found.append(word)
    return found[::-1]


def test_the_readme_names_exactly_the_rows_that_phi_has(made: Package) -> None:
    told = [{"joint": line[0], "row": row} for line in table(made, "Joints") for row in spread_out(line[-1])]
    assert told == [row for row in made.manifest["scene"]["rows"] if row["row"] != "drive"]


def test_rows_that_the_readme_calls_redundant_are_and_the_others_are_not(made: Package) -> None:
    """By singular values of the Jacobian of all rows at poses near by, at which the joints are closed."""
    judged = made.judged
    system = constraint_system(judged.assembly.scene, judged.assembly.forms, judged.undropped.dropped)
    told = set()
    for joint, rows in re.findall(r'^ +joint "(.*)": (.*)$', made.readme, re.MULTILINE):
        told |= {(joint, row) for row in rows.split(", ")}
    names = [(joint.name, row.name) for joint in system.joints for row in joint.rows]
    left_out = {(row["joint"], row["row"]) for row in made.manifest["scene"]["left_out"]}
    assert told <= left_out
    assert {name for name in names if name in told} == told, "each is a row of the mechanism"
    kept = [k for k, name in enumerate(names) if name not in told]
    jacobian = system.values(judged.pose)[1]
    ranks = [np.linalg.matrix_rank(matrix, 1e-7) for matrix in (jacobian[kept], jacobian)]
    if made.name == "in_line_engine_parametric" and made.case.rows is None:
        assert "singular configuration: at the given pose the rank is 18, elsewhere 21" in made.readme
        return
    assert ranks[0] == ranks[1] == len(kept)


def test_only_what_is_asked_for_is_emitted(made: Package) -> None:
    asked = set(made.case.quantities) | ({"jacobian"} if "residual" in made.case.quantities else set())
    outputs = {entry["output"] for entry in made.entries}
    assert outputs - {"all"} == asked
    constraints = [name for name in made.case.quantities if name not in ("mass", "force", "residual")]
    assert ("all" in outputs) == (len(constraints) > 1)
    text = made.source.read_text() + (made.root / f"{made.name}.h").read_text()
    defined = set(re.findall(rf"jg_{made.name}_(\w+?)(?:_nz|_dense|_sparsity)?\(", text))
    assert defined == outputs


def test_the_readme_lists_every_function_with_its_operations(made: Package) -> None:
    told = {line[0]: line[1] for line in table(made, "Functions")}
    assert {symbol: words.split(" ")[0] for symbol, words in told.items()} == {
        e["symbol"]: str(e["operations"]["total"]) for e in made.entries if e["storage"] != "dense"
    }


def bill(made: Package) -> list[tuple[str, list[int]]]:
    return [(line[0], [int(cell or 0) for cell in line[1:]]) for line in table(made, "What the scene saves")]


def test_the_in_line_engine_takes_no_more_operations_than_the_prototype_did(scene_packages: Path) -> None:
    """263 in space, 27 in the plane."""
    engine = package("engine", scene_packages)
    steps = bill(engine)
    assert [words for words, _ in steps] == [
        "the library's routine of each joint",
        "geometry folded as constants",
        "columns of the ground left out",
        "joints evaluated together",
        "redundant rows left out",
    ]
    assert steps[-1][1][0] <= 263
    in_plane = re.search(r'With `motion = "planar"` in the file they would be (\d+) operations\.', engine.readme)
    assert in_plane is not None
    assert int(in_plane[1]) <= 27


def test_the_engine_with_coordinates_takes_no_more_operations_than_the_prototype_did(scene_packages: Path) -> None:
    """131 with rows of Table 4, 160 with regular ones; sines and cosines apart."""
    table4 = package("engine with table4 rows", scene_packages)
    operations, _, trigonometric = bill(table4)[-1][1]
    assert operations <= 131
    assert trigonometric == 3
    regular = package("engine with regular rows", scene_packages)
    counts = next(e["operations"] for e in regular.entries if e["output"] == "all")
    assert counts["total"] - counts["sincos"] <= 160


def test_what_each_step_saves_is_the_difference_of_two_lines(scene_packages: Path) -> None:
    for name in ("engine", "engine with table4 rows"):
        steps = [numbers for _, numbers in bill(package(name, scene_packages))]
        assert steps[0][1] == 0
        for before, after in pairwise(steps):
            assert after[1] == before[0] - after[0]
        fused = next(e for e in package(name, scene_packages).entries if e["output"] == "all")
        assert sum(steps[-1][:1] + steps[-1][2:]) == fused["operations"]["total"]
