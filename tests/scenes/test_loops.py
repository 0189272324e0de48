"""Loops over equal parts give what straight-line code gives, bit for bit, from C and from CasADi."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any, overload

import numpy as np
import pytest

from codegen.dynamics.layout import layout
from codegen.emit.routine import Routine
from codegen.emit.scene_package import ScenePackage, scene_files
from codegen.emit.scene_record import scene_record
from codegen.emit.scene_subject import SceneSubject
from codegen.errors import SpecificationError
from codegen.ir.evaluate import evaluate
from codegen.ir.looped import Looped
from codegen.ir.ops import Constant
from codegen.ir.program import Program
from codegen.measure.row_names import Row
from codegen.mechanics.assembly import Assembly
from codegen.mechanics.system import System
from codegen.passes import simplify
from codegen.passes.unroll import unroll, unroll_short
from codegen.scenes.generate import check_options
from codegen.scenes.loops import decided
from codegen.scenes.numbers import rows_of
from flopcount.count import count
from tests.harness.library import Library, compile_library

from .copied import ALL, CONSTRAINTS, in_the_plane, looped, parts, planned, whole
from .mechanisms import pose
from .workshop import values

STRICT = ("-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Wmissing-prototypes", "-Werror")
CASES = ("conventional", "both", "substituted", "planar")
FOUR = CONSTRAINTS[:4]
every_case = pytest.mark.parametrize("case", CASES)


@cache
def assembly(case: str, count: int = 3) -> Assembly:
    """Some equal parts with attachments of their own."""
    if case == "planar":
        return in_the_plane(count)
    return parts("both", count, "substituted") if case == "substituted" else parts(case, count)


@cache
def loops(case: str) -> Looped:
    """Their routine of all quantities, in loops."""
    return looped(assembly(case))


@cache
def straight(case: str) -> Program:
    """The same loops written out."""
    return simplify(unroll(loops(case)))


@dataclass(frozen=True)
class Emitted:
    """A package and its compiled routines."""

    files: dict[str, bytes]
    library: Library
    symbol: str

    @property
    def entry(self) -> dict[str, Any]:
        """What the manifest says of the routine."""
        (found,) = (e for e in json.loads(self.files["manifest.json"])["functions"] if e["symbol"] == self.symbol)
        return dict(found)


def emitted(case: str, program: Program | Looped, folder: Path) -> Emitted:
    """Write and compile a routine of everything."""
    files = scene_files(package(assembly(case), program))
    for name, content in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(content)
    entries = json.loads(files["manifest.json"])["functions"]
    path = compile_library(folder, ["drawn.c"], folder, STRICT)
    return Emitted(files, Library(entries, path), "jg_drawn_all")


def package(found: Assembly, program: Program | Looped) -> ScenePackage:
    """A package of one routine."""
    names: list[tuple[str, str]] = []
    for joint in found.scene.joints:
        rows: tuple[Row, ...] = rows_of(found.forms[joint.name])
        names += [(joint.name, row.name) for row in rows]
    system = System(found)
    plan = planned(found) if isinstance(program, Looped) else None
    subject = SceneSubject(system, layout(system, "index2"), tuple(names), plan)
    routine = Routine(subject, "all", program, count(program), "none")
    singles = [replace(routine, output=name, program=of(program, name)) for name in ALL]
    start = {a.name: [Constant(Fraction(1))] * a.length for a in program.arguments}
    return ScenePackage("drawn", (*singles, routine), "0", "0", "double", scene_record(subject), {}, start, "")


@overload
def of(program: Program, name: str) -> Program: ...
@overload
def of(program: Looped, name: str) -> Looped: ...
def of(program: Program | Looped, name: str) -> Program | Looped:
    """One quantity of a routine."""
    if isinstance(program, Program):
        return simplify(replace(program, outputs=(program.output(name),)))
    only = []
    for loop in program.loops:
        alone = simplify(replace(loop.program, outputs=(loop.program.output(name),)))
        only.append(replace(loop, program=alone, outputs={name: loop.outputs[name]}))
    return replace(program, shapes={name: program.shapes[name]}, loops=tuple(only))


def numbers(case: str, seed: int) -> dict[str, np.ndarray[Any, Any]]:
    """Inputs as doubles, at a pose on no manifold."""
    return {name: np.array([float(x) for x in found]) for name, found in pose(assembly(case), seed).items()}


@every_case
def test_loops_give_exactly_what_the_scene_as_a_whole_gives(case: str) -> None:
    """In fractions, the truth being the scene lowered as one, joint by joint, without a thought of equal parts."""
    inputs = pose(assembly(case), 1)
    expected = values(whole(assembly(case), FOUR), inputs)
    for name in FOUR:
        found = values(of(straight(case), name), inputs)
        assert (found[name] == expected[name]).all(), name


@pytest.mark.parametrize("case", ["both", "planar"])
def test_forces_of_loops_are_those_of_the_scene_as_a_whole(case: str) -> None:
    """In doubles, since the length of a spring is a root."""
    inputs = {name: found.tolist() for name, found in numbers(case, 2).items()}
    (found,) = evaluate(of(straight(case), "force"), inputs).values()
    (expected,) = evaluate(whole(assembly(case), ("force",)), inputs).values()
    assert np.allclose(found, expected, rtol=1e-12, atol=1e-12) and any(found)


@every_case
def test_compiled_loops_give_the_bits_of_straight_line_code(case: str, tmp_path: Path) -> None:
    assert [loop.count for loop in loops(case).loops] == [3]
    one, other = tmp_path / "loops", tmp_path / "straight"
    in_loops, in_line = emitted(case, loops(case), one), emitted(case, straight(case), other)
    for seed in range(3):
        inputs = numbers(case, seed)
        found = in_loops.library.call("jg_drawn_all", inputs, canary=True, dense=True)
        expected = in_line.library.call("jg_drawn_all", inputs, canary=True, dense=True)
        for name in ALL:
            assert np.array_equal(found[name], expected[name]), name
            (entry, *_) = in_loops.library.find(output=name)
            alone = in_loops.library.call(entry["symbol"], inputs, canary=True, dense=True)
            assert np.array_equal(alone[name], found[name]), name


@every_case
def test_both_shapes_have_the_same_signature(case: str, tmp_path: Path) -> None:
    shapes = []
    for program, folder in ((loops(case), tmp_path / "loops"), (straight(case), tmp_path / "straight")):
        arguments = emitted(case, program, folder).entry["arguments"]
        shapes.append([(a["name"], a["direction"], a["shape"]) for a in arguments])
    assert shapes[0] == shapes[1]


def test_what_differs_between_parts_stands_in_a_table_and_all_else_in_the_statements() -> None:
    (loop,) = loops("conventional").loops
    assert len(loop.geometry) == 3 and len(set(loop.geometry)) == 3
    assert {a.name for a in loop.program.used_arguments()} >= {"geometry", "r", "A"}


@every_case
def test_the_manifest_says_where_every_part_of_every_instance_lies(case: str, tmp_path: Path) -> None:
    """Entries that the parts with their repeats cover: each of an input once, as in straight-line code."""
    found = emitted(case, loops(case), tmp_path).entry
    for argument in found["arguments"]:
        places = [
            member["offset"] + member.get("stride", 0) * k + n
            for member in argument.get("members", ())
            for k in range(member.get("count", 1))
            for n in range(member["shape"][0] * member["shape"][1])
        ]
        assert sorted(places) == list(range(argument["length"])) or not places, argument["name"]
    (told,) = found["loops"]
    assert told["instances"] == 3
    stored = {a["name"]: a["length"] for a in found["arguments"]}
    for name, length in stored.items():
        pieces = [p for p in told["pieces"] if p["array"] == name]
        assert sum(p["length"] for p in pieces) * 3 <= length
        assert all(p["start"] + 2 * p["stride"] + p["length"] <= length for p in pieces)


def test_operations_are_those_of_a_part_times_their_number() -> None:
    (loop,) = loops("conventional").loops
    assert count(loops("conventional")).total == 3 * count(loop.program).total


@every_case
def test_casadi_calls_one_function_for_all_parts_and_gives_the_same_numbers(case: str) -> None:
    from codegen.emit.casadi import casadi_function

    inputs = numbers(case, 4)
    one, other = casadi_function("one", loops(case)), casadi_function("other", straight(case))
    assert [one.name_in(k) for k in range(one.n_in())] == [other.name_in(k) for k in range(other.n_in())]
    passed = [inputs[one.name_in(k)] for k in range(one.n_in())]
    for found, expected in zip(one.call(passed), other.call(passed), strict=True):
        assert np.array_equal(np.array(found), np.array(expected))


def test_the_graph_of_casadi_does_not_grow_with_the_parts() -> None:
    from codegen.emit.casadi import casadi_function

    nodes = [casadi_function("f", looped(assembly("both", n), ("phi", "phi_q"))).n_nodes() for n in (2, 6)]
    assert nodes[0] == nodes[1]


@pytest.mark.parametrize("case", ["conventional", "both"])
def test_externals_differentiate_loops_exactly(case: str, tmp_path: Path) -> None:
    """The derivative of phi by every input, against CasADi's own of the straight-line function."""
    import casadi

    from codegen.emit.casadi import casadi_function

    emitted(case, loops(case), tmp_path)
    library = compile_library(tmp_path, ["drawn.c", "casadi/external.c"], tmp_path, (f"-I{tmp_path}",))
    external = casadi.external("jg_drawn_phi_external", str(library))
    function = casadi_function("phi", of(straight(case), "phi"))
    inputs = numbers(case, 5)
    passed = [inputs[function.name_in(k)] for k in range(function.n_in())]
    own, expected = external.jacobian(), function.jacobian()
    nominal = function(*passed)
    for found, truth in zip(own(*passed, nominal), expected(*passed, nominal), strict=True):
        assert np.allclose(np.array(found), np.array(truth), rtol=1e-14, atol=1e-14)


def test_a_scene_may_hold_several_kinds_and_single_parts(tmp_path: Path) -> None:
    """Two mechanisms in turns, then one more of the first kind: loops of two, and the rest once."""
    first, second = parts("conventional", 3), parts("both", 2)
    renamed = {body.name: f"other {body.name}" for body in second.scene.bodies} | {"ground": "ground"}
    bodies = [replace(body, name=renamed[body.name]) for body in second.scene.bodies]
    joints = [
        replace(joint, name=f"other {joint.name}", bodies=tuple(renamed[name] for name in joint.bodies))
        for joint in second.scene.joints
    ]
    scene = replace(
        first.scene,
        bodies=tuple(x for k in range(3) for x in (*first.scene.bodies[2 * k : 2 * k + 2], *bodies[2 * k : 2 * k + 2])),
        joints=tuple(x for k in range(3) for x in (*first.scene.joints[3 * k : 3 * k + 3], *joints[3 * k : 3 * k + 3])),
        springs=(),
    )
    forms = dict(first.forms) | {f"other {name}": form for name, form in second.forms.items()}
    mixed = Assembly(scene, forms)
    found = looped(mixed, FOUR)
    assert sorted(loop.count for loop in found.loops) == [2, 3]
    inputs = pose(mixed, 3)
    expected = values(whole(mixed, FOUR), inputs)
    for program in (simplify(unroll(found)), simplify(unroll(unroll_short(found, 3)))):
        emitted_values = values(program, inputs)
        assert all((emitted_values[name] == expected[name]).all() for name in FOUR)


def test_equal_parts_are_run_in_loops_unless_that_is_not_wanted() -> None:
    assert isinstance(decided(loops("both"), "never"), Program)
    assert isinstance(decided(loops("both"), "auto"), Looped)


def test_any_other_value_of_the_option_is_refused() -> None:
    with pytest.raises(SpecificationError, match="--loops"):
        check_options(None, "double", "sometimes")


def test_the_files_of_loops_are_the_same_every_time() -> None:
    first, second = (scene_files(package(parts("both", 3), looped(parts("both", 3)))) for _ in range(2))
    assert first == second


def test_the_source_of_many_parts_is_that_of_few_but_for_tables(tmp_path: Path) -> None:
    sizes = []
    for number in (3, 300):
        found = parts("both", number)
        files = scene_files(package(found, looped(found)))
        text = files["drawn.c"].decode()
        body = [line for line in text.splitlines() if "=" in line and "JG_REAL({" not in line]
        sizes.append(len(body))
    assert sizes[1] <= 1.1 * sizes[0]
