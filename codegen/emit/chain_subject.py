"""A chain as the subject of routines: the parts of its arrays link by link, cut by cut, effector by effector."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from codegen.emit.routine import Member, Preparation, Words
from codegen.errors import InternalError
from codegen.ir.looped import Looped
from codegen.ir.program import Argument, Program, Result
from codegen.mechanics.chain.model import ROW_NAMES
from codegen.spec.chain import Chain
from codegen.spec.identifiers import identifiers

_OUTPUTS: dict[str, tuple[str, str, str]] = {
    "frames": ("Frames of links, cuts and effectors", "world if the base moves, else base", "1, m"),
    "closure": ("Far frame R of each cut seen from its frame C", "C", "1, m"),
    "phi": ("Constraint phi = (p; 2 e) of the cuts, e_0 >= 0", "C", "m, 1"),
    "phi_q": ("Derivative d phi / dq, exact where cuts are open too", "C", "1, m, 1/rad"),
    "J": ("Jacobian J of the cuts: velocity of R relative to C is J qd, exact where cuts are open too", "C", "1, m"),
    "gamma_R": (
        "Bias acceleration gamma_R of the cuts: J qdd + gamma_R = 0 where they are closed",
        "C",
        "m/s^2, rad/s^2",
    ),
    "M": ("Inertia matrix M of the tree", "joint coordinates x joint coordinates", "kg, kg m, kg m^2"),
    "f_C": ("Coriolis and centrifugal forces f_C: M qdd + f_C = f_G + tau + J^T f_R + D_E^T f_E", "joints", "N, N m"),
    "f_G": ("Gravity f_G on the joint coordinates", "joints", "N, N m"),
    "D_E": ("Jacobian D_E of the effectors: their velocity is D_E qd where the base rests", "effector", "1, m"),
    "effectors": ("Velocity and acceleration of the effectors", "effector", "m/s, rad/s, m/s^2, rad/s^2"),
    "wrenches": ("Force and moment of each joint on its link, about the link's origin", "link", "N, N m"),
    "tau_A": ("Forces tau_A along the coordinates that act at all times: part of tau", "joints", "N, N m"),
    "f_A": ("Wrenches f_A at the effectors that act at all times: part of f_E", "effector", "N, N m"),
    "all": ("What the equations of motion take, at once, sub-expressions shared", "", ""),
}


@dataclass(frozen=True)
class ChainSubject:
    """A chain whose constant rows are left out.

    Attributes:
        chain: the chain.
        rows: of all cuts, six each, those that are in the routines.
    """

    chain: Chain
    rows: tuple[int, ...]

    @property
    def stem(self) -> str:
        """Start of the symbols."""
        return f"jg_{self.chain.name}"

    def routine_stem(self, output: str) -> str:
        """The symbol of a routine without its storage ending."""
        return f"{self.stem}_{output}"

    def part(self, kind: int) -> ChainSubject:
        """Chains have no loops of instances."""
        raise InternalError("no instances in straight-line code")

    def argument(self, argument: Argument) -> Words:
        """Axes, unit and parts of an argument."""
        words: dict[str, tuple[str, str, Callable[[], Iterator[Member]]]] = {
            "q": ("joints", "rad, m", lambda: self._joints("q", "")),
            "qd": ("joints", "rad/s, m/s", lambda: self._joints("qd", "/s")),
            "qdd": ("joints", "rad/s^2, m/s^2", lambda: self._joints("qdd", "/s^2")),
            "f_R": ("C", "N, N m", self._cut_wrenches),
            "f_E": ("effector", "N, N m", lambda: self._effector_wrenches("f_E")),
            "T_0": ("base to world: rotation, origin", "1, m", lambda: iter(())),
            "v_0": ("base", "m/s, rad/s", lambda: iter(())),
            "vd_0": ("base", "m/s^2, rad/s^2", lambda: iter(())),
        }
        frame, unit, members = words[argument.name]
        return Words(frame, unit, tuple(members()))

    def output(self, output: Result) -> Words:
        """Axes, unit and parts of an output."""
        _, frame, unit = _OUTPUTS.get(output.name, ("", "partial derivatives by the entries of an argument", "mixed"))
        told: dict[str, Callable[[], Iterator[Member]]] = {
            "frames": lambda: self._poses("T", self.frame_names),
            "closure": lambda: self._poses("T", self._cut_names),
            "effectors": self._motions,
            "wrenches": self._wrenches,
            "f_A": lambda: self._effector_wrenches("f_A"),
        }
        of_rows = {name: lambda: self._rows(output.name) for name in ("phi", "phi_q", "J", "gamma_R")}
        of_joints = {name: lambda: self._joints(output.name, "") for name in ("M", "f_C", "f_G", "tau_A")}
        members = (told | of_rows | of_joints).get(output.name, lambda: iter(()))
        return Words(frame, unit, tuple(members()))

    def brief(self, output: str) -> str:
        """What a routine does, in a line."""
        return f"{_OUTPUTS[output][0]}: chain {self.chain.name}."

    def details(self, output: str, program: Program | Looped, preparation: Preparation | None) -> Sequence[str]:
        """What a user must know besides, sentence by sentence."""
        names = {result.name for result in program.outputs}
        details = []
        if names & {"phi", "phi_q"}:
            details.append("Not for a cut that is turned by half a turn, where e_0 = 0: take closure there.")
        if "wrenches" in names:
            details.append("The wrench f_R acts on the chain at R and its opposite at C; f_E acts on it at E.")
        return details or ["Wrenches act on the chain."]

    def record(self) -> dict[str, Any]:
        """What the manifest says of the chain."""
        return {"chain": self.chain.name}

    # --- names

    @property
    def links(self) -> tuple[str, ...]:
        """Identifiers of the links."""
        return tuple(identifiers(link.name for link in self.chain.links).values())

    @property
    def _cut_names(self) -> tuple[str, ...]:
        return tuple(identifiers(cut.name for cut in self.chain.cuts).values())

    @property
    def _effector_names(self) -> tuple[str, ...]:
        return tuple(identifiers(effector.name for effector in self.chain.effectors).values())

    @property
    def frame_names(self) -> tuple[str, ...]:
        """Identifiers of all frames: links, C and R of the cuts, effectors."""
        cuts = self._cut_names
        return (
            *self.links,
            *(f"C_{name}" for name in cuts),
            *(f"R_{name}" for name in cuts),
            *(f"E_{name}" for name in self._effector_names),
        )

    # --- parts of arrays

    def _joints(self, word: str, per: str) -> Iterator[Member]:
        for k, (name, link) in enumerate(zip(self.links, self.chain.links, strict=True)):
            yield f"{word}_{name}", k, (1, 1), f"{link.unit}{per}"

    def _cut_wrenches(self) -> Iterator[Member]:
        for k, name in enumerate(self._cut_names):
            yield f"f_R_{name}", 6 * k, (6, 1), "force and moment at R on the chain, axes of C"

    def _effector_wrenches(self, word: str) -> Iterator[Member]:
        for k, name in enumerate(self._effector_names):
            yield f"{word}_{name}", 6 * k, (6, 1), "force and moment on the chain"

    def _poses(self, word: str, names: Sequence[str]) -> Iterator[Member]:
        for k, name in enumerate(names):
            yield f"{word}_{name}", 12 * k, (3, 4), "rotation, origin"

    def _motions(self) -> Iterator[Member]:
        for k, name in enumerate(self._effector_names):
            yield f"v_{name}", 12 * k, (6, 1), "velocity of the origin, angular velocity"
            yield f"vd_{name}", 12 * k + 6, (6, 1), "acceleration of the origin, angular acceleration"

    def _wrenches(self) -> Iterator[Member]:
        for k, name in enumerate(self.links):
            yield f"f_{name}", 6 * k, (6, 1), "force, moment"

    def _rows(self, word: str) -> Iterator[Member]:
        first = 0
        for cut, name in enumerate(self._cut_names):
            own = [ROW_NAMES[row % 6] for row in self.rows if row // 6 == cut]
            if own:
                yield f"{word}_{name}", first, (len(own), 1), f"rows {', '.join(own)}"
            first += len(own)
