"""A scene as the subject of routines: the parts of its arrays body by body and joint by joint."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from codegen.dynamics.layout import Layout
from codegen.emit.attitude_subject import ATTITUDE_BRIEFS, ATTITUDE_DETAILS
from codegen.emit.joint_subject import BRANCH_WORDS
from codegen.emit.routine import Member, Preparation, Words
from codegen.errors import InternalError
from codegen.ir.looped import Axis, Looped
from codegen.ir.program import Argument, Program, Result
from codegen.mechanics.assembly import Assembly
from codegen.mechanics.plan import Plan, Series
from codegen.mechanics.system import System
from codegen.spec.request import BRANCH
from codegen.spec.scene import COORDINATE_UNITS

_WITHOUT_AXES = ("phi", "branch", *ATTITUDE_BRIEFS)

_OUTPUTS: dict[str, tuple[str, str, str]] = {
    "phi": ("Constraints phi of all joints", "constraint rows", "m or 1"),
    "phi_q": ("Jacobian phi_q by the virtual displacements", "constraint rows x virtual displacements", "1, m, 1/rad"),
    "phi_q_t_lambda_q": (
        "Second derivative d(phi_q^T lambda)/dq by the same virtual displacements (not symmetric)",
        "virtual displacements x virtual displacements",
        "N/m, N, N m",
    ),
    "gamma": (
        "Right-hand side gamma of phi_q a = gamma at acceleration level",
        "constraint rows",
        "m/s^2 or 1/s^2",
    ),
    "phi_q_v": ("Product phi_q v, without forming phi_q", "constraint rows", "m/s or 1/s"),
    "phi_q_t_lambda": ("Product phi_q^T lambda, without forming phi_q", "virtual displacements", "N, N m"),
    "branch": ("Branch of each joint: 1 where it is closed as it was meant, negative where not", "joints", "1"),
    "orthonormalise": (ATTITUDE_BRIEFS["orthonormalise"], "bodies", "1"),
    "check_orthonormal": (ATTITUDE_BRIEFS["check_orthonormal"], "bodies", "1"),
    "mass": ("Mass matrix M, constant", "virtual displacements x virtual displacements", "kg, kg m^2"),
    "force": (
        "Right-hand side of M a + phi_q^T lambda = force: applied and gyroscopic forces",
        "virtual displacements",
        "N, N m",
    ),
    "residual": (
        "Residual F(t, y, ydot) of the equations of motion, stabilised index 2 (Gear, Gupta, Leimkuhler)",
        "rows of the equations of motion",
        "mixed",
    ),
    "jacobian": (
        "Jacobian dF/dy + cj dF/dydot of the residual",
        "rows of the equations of motion x state",
        "mixed",
    ),
    "all": ("All constraint quantities at once, sub-expressions shared", "", ""),
}


@dataclass(frozen=True)
class SceneSubject:
    """A scene whose joints have their forms and whose rows are chosen.

    Attributes:
        system: the scene.
        state: layout of the state of an integrator.
        row_names: joint and name of each row of all joints.
        plan: where the routines are loops, the instances.
    """

    system: System
    state: Layout
    row_names: tuple[tuple[str, str], ...]
    plan: Plan | None = None

    @property
    def assembly(self) -> Assembly:
        """The scene without its forces and drives."""
        return self.system.assembly

    @property
    def stem(self) -> str:
        """Start of the symbols."""
        return f"jg_{self.assembly.scene.name}"

    def routine_stem(self, output: str) -> str:
        """The symbol of a routine without its storage ending."""
        return f"{self.stem}_{output}"

    def argument(self, argument: Argument) -> Words:
        """Axes, unit and parts of an argument."""
        words: dict[str, tuple[str, str, Callable[[], Iterator[Member]]]] = {
            "r": ("world", "m", self._positions),
            "A": ("body to world", "1", self._attitudes),
            "alpha": ("joint", "m, rad", lambda: self._coordinates("alpha")),
            "revolutions": ("joint", "1", self._revolutions),
            "velocity": (self.axes, "m/s, rad/s", self._velocities),
            "lambda": ("constraint rows", "N, N m", lambda: self._rows("lambda")),
            "t": ("time", "s", lambda: iter(())),
            "y": ("state", "mixed", lambda: self._state("")),
            "ydot": ("rate of the state", "mixed", lambda: self._state("dot")),
            "cj": ("weight of dF/dydot", "1/s", lambda: iter(())),
        }
        frame, unit, members = words[argument.name]
        if self.plan is None or argument.name in ("y", "ydot"):
            return Words(frame, unit, tuple(members()))
        found, repeats = _of_instances(
            (series, series.argument(argument.name), subject.argument(argument).members)
            for series, subject in self._series
        )
        return Words(frame, unit, found, repeats)

    def output(self, output: Result) -> Words:
        """Axes, unit and parts of an output."""
        _, frame, unit = _OUTPUTS.get(output.name, ("", "partial derivatives by the entries of an argument", "mixed"))
        axes = frame if output.name in _WITHOUT_AXES else f"{frame}; {self.axes}"
        told = {
            "constraint rows": self._rows,
            "virtual displacements": self.displacements,
            "joints": self._joints,
            "bodies": self._matrices if output.name == "orthonormalise" else self._numbers,
        }
        if frame not in told:
            return Words(axes, unit)
        if self.plan is None:
            return Words(axes, unit, tuple(told[frame](output.name)))
        found, repeats = _of_instances(
            (series, series.output(output.name)[0], subject.output(output).members) for series, subject in self._series
        )
        return Words(axes, unit, found, repeats)

    @property
    def parts(self) -> tuple[tuple[SceneSubject, int], ...]:
        """What is told one by one: the whole scene, or the first instance of each series; and how often it comes."""
        if self.plan is None:
            return ((self, 1),)
        return tuple((subject, len(series.sections)) for series, subject in self._series)

    @property
    def parts_of_displacements(self) -> tuple[tuple[Member, ...], _Repeats]:
        """The columns of ``phi_q``; of series those of the first instance, and how often each comes."""
        if self.plan is None:
            return tuple(self.displacements("delta")), {}
        return _of_instances(
            (series, series.axes["displacements"], tuple(subject.displacements("delta")))
            for series, subject in self._series
        )

    def part(self, kind: int) -> SceneSubject:
        """The first instance of a kind, as a scene of its own.

        Raises:
            InternalError: the routines are no loops.
        """
        if self.plan is None:
            raise InternalError("no instances in straight-line code")
        return self._alone(self.plan.kinds[kind])

    @cached_property
    def _series(self) -> list[tuple[Series, SceneSubject]]:
        return [(series, self._alone(series.first)) for series in (self.plan.series if self.plan else ())]

    def _alone(self, system: System) -> SceneSubject:
        joints = {joint.name for joint in system.assembly.scene.joints}
        return SceneSubject(system, self.state, tuple(pair for pair in self.row_names if pair[0] in joints))

    def brief(self, output: str) -> str:
        """What a routine does, in a line."""
        return f"{_OUTPUTS[output][0]}: scene {self.assembly.scene.name}."

    def details(self, output: str, program: Program | Looped, preparation: Preparation | None) -> Sequence[str]:
        """What a user must know besides, sentence by sentence."""
        if output in ATTITUDE_DETAILS:
            return [ATTITUDE_DETAILS[output]]
        if output == BRANCH:
            return [BRANCH_WORDS]
        details = [f"Virtual displacements: {self.axes}.", "The parts of A are taken as rotations."]
        if any(variant.derivative == "substituted" for variant in self.assembly.forms.values()):
            details.append("Joint relations are inserted before differentiation: exact on tangent directions only.")
        return details

    def record(self) -> dict[str, Any]:
        """What the manifest says of the scene."""
        return {"scene": self.assembly.scene.name}

    @cached_property
    def axes(self) -> str:
        """Axes of virtual displacements and velocities, in words."""
        turning = "about the normal of the plane" if self.assembly.arrays.is_planar else "in body axes"
        return f"translations in {self.assembly.translations} axes, rotations {turning}"

    # --- parts of arrays

    @property
    def _bodies(self) -> Sequence[str]:
        return [self.assembly.bodies[body.name] for body in self.assembly.scene.bodies]

    def _positions(self) -> Iterator[Member]:
        size = self.assembly.arrays.position
        for k, body in enumerate(self._bodies):
            yield f"r_{body}", size * k, (size, 1), "centre of mass, world axes, m"

    def _attitudes(self) -> Iterator[Member]:
        size = self.assembly.arrays.position
        for k, body in enumerate(self._bodies):
            yield f"A_{body}", size * size * k, (size, size), "attitude, body to world"

    def _velocities(self) -> Iterator[Member]:
        arrays, moving = self.assembly.arrays, self.assembly.translations
        turn = arrays.displacements - arrays.position
        for k, body in enumerate(self._bodies):
            first = arrays.displacements * k
            yield f"v_{body}", first, (arrays.position, 1), f"velocity of the centre of mass, {moving} axes, m/s"
            turning = "about the normal" if arrays.is_planar else "body axes"
            yield f"omega_{body}", first + arrays.position, (turn, 1), f"angular velocity, {turning}, rad/s"
        first = arrays.displacements * len(self._bodies)
        yield from ((name, first + k, shape, f"{unit}/s") for name, k, shape, unit in self._coordinates("alphadot"))

    def displacements(self, word: str) -> Iterator[Member]:
        """Parts of an array over the virtual displacements: the columns of ``phi_q``."""
        arrays, moving = self.assembly.arrays, self.assembly.translations
        turn = arrays.displacements - arrays.position
        turning = "about the normal" if arrays.is_planar else "body axes"
        for k, body in enumerate(self._bodies):
            first = arrays.displacements * k
            yield f"{word}_r_{body}", first, (arrays.position, 1), f"translation, {moving} axes"
            yield f"{word}_pi_{body}", first + arrays.position, (turn, 1), f"rotation, {turning}"
        first = arrays.displacements * len(self._bodies)
        parts = self._coordinates(f"{word}_alpha")
        yield from ((name, first + k, shape, unit) for name, k, shape, unit in parts)

    def _coordinates(self, word: str) -> Iterator[Member]:
        for placed in self.assembly.placed:
            if placed.form.coordinates:
                units = ", ".join(COORDINATE_UNITS[placed.joint.type])
                place = placed.ends.first_alpha
                yield f"{word}_{placed.ends.name}", place, (placed.form.coordinates, 1), units

    def _state(self, ending: str) -> Iterator[Member]:
        state = self.state
        groups = {
            "positions": (
                state.positions,
                "x, y and angle of each body, then alpha"
                if self.assembly.arrays.is_planar
                else "r and Euler parameters w x y z of each body, then alpha",
            ),
            "velocities": (state.velocities, "v (world) and omega (body axes) of each body, then alphadot"),
            "multipliers": (state.multipliers, "lambda, row by row"),
            "corrections": (state.corrections, "mu, row by row; 0 on solutions"),
        }
        for name, (places, words) in groups.items():
            if places:
                yield f"{name}{ending}", places.start, (len(places), 1), words

    def _revolutions(self) -> Iterator[Member]:
        screws = [p for p in self.assembly.placed if p.joint.type == "screw" and not p.form.coordinates]
        for k, placed in enumerate(screws):
            yield f"revolutions_{placed.ends.name}", k, (1, 1), "whole turns"

    def _matrices(self, word: str) -> Iterator[Member]:
        yield from ((f"{word}_{body}", k, shape, words) for body, (_, k, shape, words) in self._with_bodies)

    def _numbers(self, word: str) -> Iterator[Member]:
        yield from ((f"{word}_{body}", k, (1, 1), "norm") for k, body in enumerate(self._bodies))

    @property
    def _with_bodies(self) -> Iterator[tuple[str, Member]]:
        return zip(self._bodies, self._attitudes(), strict=True)

    def _joints(self, word: str) -> Iterator[Member]:
        for placed in self.assembly.placed:
            yield f"{word}_{placed.ends.name}", placed.ends.number, (1, 1), "cosine of the angle that the joint is off"

    def _rows(self, word: str) -> Iterator[Member]:
        number = {row: k for k, row in enumerate(self.assembly.rows)}
        for placed in self.assembly.placed:
            first = placed.ends.first_row
            rows = [row for row in range(first, first + placed.form.row_count) if row in number]
            if rows:
                names = row_words(self.row_names[row][1] for row in rows)
                yield f"{word}_{placed.ends.name}", number[rows[0]], (len(rows), 1), f"rows {names}"
        for k, driven in enumerate(self.system.drives):
            yield f"drive_{k}_{word}", len(number) + k, (1, 1), f"drive of coordinate {driven.alpha} of alpha"


def row_words(names: Iterable[str]) -> str:
    """Name rows of a joint one after the other; components of one vector together, as ``x, y of the point``."""
    found: list[tuple[str, list[str]]] = []
    for name in names:
        component, _, vector = name.partition(" of ")
        if vector and found and found[-1][0] == vector:
            found[-1][1].append(component)
        else:
            found.append((vector, [component]) if vector else ("", [name]))
    return ", ".join(", ".join(parts) + (f" of {vector}" if vector else "") for vector, parts in found)


_Repeats = dict[int, tuple[int, int]]


def _of_instances(
    found: Iterable[tuple[Series, Axis, Sequence[Member]]],
) -> tuple[tuple[Member, ...], _Repeats]:
    """The parts of an array of the first instances, at their places in the whole, and how often each comes."""
    members: list[Member] = []
    repeats: _Repeats = {}
    for series, axis, own in found:
        for name, offset, shape, meaning in own:
            first = 0
            for segment in axis:
                if first <= offset < first + segment.length:
                    place = segment.start + offset - first
                    members.append((name, place, shape, meaning))
                    repeats[place] = len(series.sections), segment.stride
                first += segment.length
    return tuple(sorted(members, key=lambda member: member[1])), repeats
