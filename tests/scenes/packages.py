"""Packages of the examples, and what they are made from; each is made once for all test processes and later runs."""

from __future__ import annotations

import json
import pickle
from collections.abc import Mapping
from contextlib import nullcontext
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np

from codegen import output
from codegen.dynamics.layout import layout
from codegen.mechanics.assembly import Assembly
from codegen.mechanics.system import System
from codegen.scenes import generate
from codegen.scenes.bill import Bill
from codegen.scenes.generate import Judged
from codegen.scenes.read import read
from codegen.scenes.start import start
from codegen.spec.scene import Scene, Wanted
from tests.harness.library import Array, Library, digest, run_compiler
from tests.truth.workshop import fingerprint, locked

from .truth import quantities

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


@dataclass(frozen=True)
class Case:
    """A request.

    Attributes:
        file: of the examples.
        quantities: what is asked for; empty for everything.
        motion: in the place of that in the file.
        form: of all joints that may have it.
        real: number type.
        rows: of parametric joints.
        with_bill: whether the README has its bill, which takes longer than all the rest.
    """

    file: str
    quantities: tuple[str, ...]
    motion: str | None = None
    form: str | None = None
    real: str = "double"
    rows: str | None = None
    with_bill: bool = False

    def scene(self) -> Scene:
        """The mechanism as the file and the request have it."""
        scene, _ = read(EXAMPLES / self.file)
        wanted = Wanted(self.quantities, self.rows or scene.wanted.rows, scene.wanted.derivative)
        return replace(scene, motion=self.motion or scene.motion, wanted=wanted)


THREE = ("phi", "phi_q", "phi_q_t_lambda_q")
CONSTRAINTS = (*THREE, "gamma", "phi_q_v", "phi_q_t_lambda")

CASES = {
    "engine": Case("in_line_engine.toml", THREE, with_bill=True),
    "engine in the plane": Case(
        "in_line_engine.toml", (*CONSTRAINTS, "mass", "force", "residual"), "planar", "conventional"
    ),
    "engine with table4 rows": Case("in_line_engine_parametric.toml", THREE, with_bill=True),
    "engine with regular rows": Case("in_line_engine_parametric.toml", THREE, rows="regular"),
    "four-bar in the plane": Case("four_bar.toml", ("phi", "phi_q", "gamma"), form="parametric"),
    "four-bar of MJCF": Case("four_bar.xml", ("phi_q_v", "phi_q_t_lambda"), form="conventional"),
    "spatial slider-crank": Case("spatial_slider_crank.toml", ("phi", "phi_q", "gamma"), form="conventional"),
    "spatial slider-crank in float": Case("spatial_slider_crank.toml", ("phi", "phi_q"), None, "conventional", "float"),
    "Bricard": Case("bricard.toml", ("phi", "phi_q", "gamma"), form="conventional"),
    "Stewart": Case("stewart.toml", ("phi", "phi_q"), form="conventional"),
    "robot": Case("robot.urdf", ("phi", "phi_q_t_lambda")),
}

STRICT = (
    "-std=c99",
    "-Wall",
    "-Wextra",
    "-Wpedantic",
    "-Wconversion",
    "-Wshadow",
    "-Wmissing-prototypes",
    "-Wdouble-promotion",
    "-Wvla",
    "-Werror",
)


@dataclass(frozen=True)
class Package:
    """A package on disk.

    Attributes:
        case: what it was made from.
        root: its folder.
    """

    case: Case
    root: Path

    @cached_property
    def judged(self) -> Judged:
        """Forms and rows of its joints."""
        forms, dropped, zero, mobility, pose, scene = pickle.loads(self.root.with_suffix(".pickle").read_bytes())
        return Judged({}, Assembly(scene, forms, zero), Assembly(scene, forms, dropped), mobility, pose)

    @cached_property
    def manifest(self) -> dict[str, Any]:
        """The manifest."""
        found: dict[str, Any] = json.loads((self.root / "manifest.json").read_text())
        return found

    @property
    def entries(self) -> list[dict[str, Any]]:
        """The manifest's functions."""
        found: list[dict[str, Any]] = self.manifest["functions"]
        return found

    @property
    def name(self) -> str:
        """Of the scene."""
        return str(self.manifest["scene"]["name"])

    @property
    def source(self) -> Path:
        """The C source."""
        return self.root / f"{self.name}.c"

    @property
    def readme(self) -> str:
        """The README."""
        return (self.root / "README.md").read_text()

    def library(self, *flags: str) -> Library:
        """The routines, to be called from Python."""
        target = self.root.parent / f"{digest(self.source.read_bytes(), *flags)}.so"
        command = ["gcc", *STRICT, *(flags or ("-O1",)), "-fPIC", "-shared", str(self.source), "-lm"]
        return Library(self.entries, run_compiler(command, target))


def package(name: str, folder: Path, cases: Mapping[str, Case] = CASES) -> Package:
    """Give the package of a case.

    Args:
        name: of the case.
        folder: where packages of the same sources are kept.
        cases: where it is looked up.
    """
    case = cases[name]
    root = folder / digest(repr(case), (EXAMPLES / case.file).read_bytes())
    with locked(root.with_suffix(".lock")):
        if not root.exists():
            root.with_suffix(".pickle").write_bytes(pickle.dumps(_made(case, root)))
    return Package(case, root)


def _made(case: Case, root: Path) -> tuple[Any, ...]:
    """Write a package; say what its joints and rows are."""
    found: list[Judged] = []

    def judge(*arguments: Any) -> Judged:
        found.append(generate_judge(*arguments))
        return found[-1]

    generate_judge = generate.judge
    no_bill = nullcontext() if case.with_bill else mock.patch.object(generate, "_bill", lambda *_: Bill(()))
    with mock.patch.object(generate, "judge", judge), no_bill:
        files = generate.generate_scene(case.scene(), case.form, case.real)
    output.replace(root, files)
    judged = found[0]
    assembly = judged.assembly
    return assembly.forms, assembly.dropped, judged.undropped.dropped, judged.mobility, judged.pose, assembly.scene


def kept_in(cache: Path) -> Path:
    """The folder for packages of the sources as they are."""
    folder = cache / digest(fingerprint())
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def inputs_of(made: Package, seed: int = 0) -> dict[str, list[float]]:
    """Inputs of a package's routines, from the manifest: those of t = 0, or at poses anywhere for a seed above 0.

    Attitudes are rotations, in planar motion turns about the normal.
    """
    lengths = {a["name"]: a["length"] for e in made.entries for a in e["arguments"] if a["direction"] == "in"}
    if seed == 0:
        judged = made.judged
        system = System(judged.assembly)
        at_start = start(system, judged.pose, layout(system, "index2"))
        return {name: [float(entry.rational) for entry in at_start[name]] for name in lengths}
    source = np.random.default_rng(seed)
    found = {name: source.normal(size=length).tolist() for name, length in lengths.items()}
    if "A" in found:
        bodies = len(made.manifest["scene"]["bodies"])
        is_planar = made.manifest["scene"]["motion"] == "planar"
        found["A"] = [x for _ in range(bodies) for x in (turn if is_planar else rotation)(source).T.ravel()]
    return found


def turn(source: np.random.Generator) -> Array:
    """A rotation in the plane."""
    angle = source.uniform(-np.pi, np.pi)
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s], [s, c]])


def rotation(source: np.random.Generator) -> Array:
    """A rotation in space."""
    found, _ = np.linalg.qr(source.normal(size=(3, 3)))
    return found * np.linalg.det(found)


def truth(made: Package, inputs: Mapping[str, list[float]]) -> dict[str, Array]:
    """Quantities of the constraints that no part of the generator has a hand in; see `tests.scenes.truth`.

    A planar mechanism is taken as one in space whose bodies are in the plane; its displacements are three of the six of
    a body.
    """
    assembly = made.judged.assembly
    spatial = replace(assembly, scene=replace(assembly.scene, motion="spatial"))
    bodies = len(assembly.scene.bodies)
    size, coordinates = 6 * bodies, assembly.coordinates
    full = {"alpha": [], "revolutions": [], **inputs}
    full.setdefault("lambda", [0.0] * len(assembly.rows))
    full.setdefault("velocity", [0.0] * len(assembly.columns))
    full.setdefault("r", [0.0] * assembly.arrays.position * bodies)
    if not full["alpha"]:
        full["alpha"] = [0.0] * coordinates
    kept = list(range(size + coordinates))
    if assembly.arrays.is_planar:
        kept = [6 * k + column for k in range(bodies) for column in (0, 1, 5)] + kept[size:]
        velocity = np.zeros(size + coordinates)
        velocity[kept] = full["velocity"]
        full |= {
            "r": [x for k in range(bodies) for x in (*full["r"][2 * k : 2 * k + 2], 0.0)],
            "A": [x for k in range(bodies) for x in _lifted(full["A"][4 * k : 4 * k + 4])],
            "velocity": velocity.tolist(),
        }
    found = quantities(spatial, full)
    return {
        **found,
        "phi_q": found["phi_q"][:, kept],
        "phi_q_t_lambda_q": found["phi_q_t_lambda_q"][np.ix_(kept, kept)],
        "phi_q_t_lambda": found["phi_q_t_lambda"][kept],
    }


def _lifted(A: list[float]) -> list[float]:
    return [A[0], A[1], 0.0, A[2], A[3], 0.0, 0.0, 0.0, 1.0]
