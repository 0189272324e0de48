"""The equations of motion of a scene: constraints of the joints, drives, forces.

Rows: those of the joints, then one for each drive, ``alpha - p(t) = 0`` with ``p = position + speed t + amplitude
sin(frequency t + phase)``, named ``drive of JOINT``. With ``M a + phi_q^T lambda = force`` the effort of a drive, along
its coordinate, is minus its multiplier. In the row of a drive ``phi_t`` is ``-pdot`` and ``gamma`` is ``pddot``; in
others ``phi_t`` is 0.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import sympy

from codegen.ir.lower import Block, Part, SymbolicOutput
from codegen.ir.program import Argument
from codegen.mechanics import frames
from codegen.mechanics.assembly import KINDS, Assembly
from codegen.mechanics.blocks import gathered
from codegen.mechanics.condensed import Condensed, condensed
from codegen.mechanics.forces import FORCES, Forces, scalar_places
from codegen.mechanics.placed import rational
from codegen.spec.request import Variant
from codegen.spec.scene import Drive

_TIME = sympy.Symbol("t")


@dataclass(frozen=True, slots=True)
class Driven:
    """A joint coordinate with a prescribed motion.

    Attributes:
        joint: name.
        alpha: number of the coordinate among those of all joints.
        drive: its motion.
    """

    joint: str
    alpha: int
    drive: Drive


@dataclass(frozen=True)
class System:
    """An assembly with its drives and forces; the same questions are answered as by `Assembly`.

    Attributes:
        assembly: the joints.
    """

    assembly: Assembly

    @cached_property
    def drives(self) -> tuple[Driven, ...]:
        """In the order of their rows."""
        return tuple(
            Driven(placed.joint.name, placed.ends.first_alpha + k, coordinate.drive)
            for placed in self.assembly.placed
            for k, coordinate in enumerate(placed.joint.coordinates)
            if coordinate.drive is not None
        )

    @property
    def row_count(self) -> int:
        """Rows of the system."""
        return len(self.assembly.rows) + len(self.drives)

    def phi_t(self, t: float) -> tuple[float, ...]:
        """Partial derivative of ``phi`` by time at a time, row by row, m/s or rad/s."""
        return (*(0.0 for _ in self.assembly.rows), *(-driven.drive.rate(t) for driven in self.drives))

    @cached_property
    def condensed(self) -> Condensed:
        """The joint coordinates that constants tie to the rest where the joints are closed."""
        forms = {name: _substituted(variant) for name, variant in self.assembly.forms.items()}
        if forms == dict(self.assembly.forms):
            return _condensed(self.assembly)
        found = _condensed(replace(self.assembly, forms=forms))
        return replace(found, is_constant=found == _condensed(self.assembly))

    @cached_property
    def _forces(self) -> Forces:
        return Forces(self.assembly)

    # --- arguments

    def arguments(self) -> tuple[Argument, ...]:
        """Arrays of the signature: those of the assembly, then the time where there are drives."""
        multipliers = Argument("lambda", (self.row_count, 1))
        arrays = (multipliers if a.name == "lambda" else a for a in self.assembly.arguments())
        return (*arrays, *([Argument("t", (1, 1))] if self.drives else []))

    def inputs(self) -> dict[Any, tuple[str, int]]:
        """Say for each symbol which argument it is read from, and at which offset."""
        first, rows = self.assembly.all_rows, len(self.assembly.rows)
        multipliers = frames.multipliers(first + len(self.drives))[first:]
        found = self.assembly.inputs() | self._forces.inputs() | {_TIME: ("t", 0)}
        return found | {symbol: ("lambda", rows + k) for k, symbol in enumerate(multipliers)}

    # --- outputs

    def parts(self, names: Iterable[str]) -> list[Part]:
        """Derive quantities of constraints and forces, in the groups that are evaluated together."""
        names = tuple(names)
        constraints = tuple(name for name in names if name not in FORCES)
        parts = [self._widened(part) for part in self.assembly.parts(constraints)] if constraints else []
        if constraints and (self.drives or not parts):
            sines = {_sine(k): _swing(driven.drive) for k, driven in enumerate(self.drives) if driven.drive.amplitude}
            places = scalar_places(stages=sines)
            parts.append(Part(places, tuple(self._drive_rows(name) for name in constraints)))
        return parts + self._forces.parts(tuple(name for name in names if name in FORCES))

    def selection(self, name: str) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """The rows and columns of a derived quantity that the system has."""
        first = self.assembly.all_rows
        drives = tuple(range(first, first + len(self.drives)))
        chosen = {
            "constraints": (*self.assembly.rows, *drives),
            "displacements": self.assembly.columns,
            "joints": tuple(range(len(self.assembly.placed))),
            "one": (0,),
        }
        rows, columns = _kinds(name)
        return chosen[rows], chosen[columns]

    # --- drives

    def _widened(self, part: Part) -> Part:
        """Add the rows of the drives, still empty."""
        outputs = tuple(SymbolicOutput(output.name, self._shape(output.name), output.blocks) for output in part.outputs)
        return replace(part, outputs=outputs)

    def _shape(self, name: str) -> tuple[int, int]:
        assembly = self.assembly
        displacements = assembly.arrays.derived * len(assembly.scene.bodies) + assembly.coordinates
        rows, joints = assembly.all_rows + len(self.drives), len(assembly.placed)
        sizes = {"constraints": rows, "displacements": displacements, "joints": joints, "one": 1}
        kinds = _kinds(name)
        return sizes[kinds[0]], sizes[kinds[1]]

    def _drive_rows(self, name: str) -> SymbolicOutput:
        assembly = self.assembly
        count, first = assembly.coordinates, assembly.all_rows
        multipliers = frames.multipliers(first + len(self.drives))
        first_column = assembly.arrays.derived * len(assembly.scene.bodies)
        blocks = []
        for k, driven in enumerate(self.drives):
            row, column = first + k, first_column + driven.alpha
            drive = driven.drive
            swing = rational(drive.amplitude) * _sine(k) if drive.amplitude else sympy.S.Zero
            prescribed = rational(drive.position) + rational(drive.speed) * _TIME + swing
            written = {
                "phi": Block(row, 0, frames.alpha(count)[driven.alpha] - prescribed),
                "phi_q": Block(row, column, sympy.S.One),
                "phi_q_v": Block(row, 0, frames.alpha_dot(count)[driven.alpha]),
                "phi_q_t_lambda": Block(column, 0, multipliers[row]),
            }
            if swing != 0:
                written["gamma"] = Block(row, 0, -(rational(drive.frequency) ** 2) * swing)
            blocks += [written[name]] if name in written else []
        return gathered(name, self._shape(name), blocks)


def _sine(number: int) -> Any:
    """The sine of a drive."""
    return sympy.Symbol(f"sine_of_drive_{number}")


def _swing(drive: Drive) -> Any:
    return sympy.sin(rational(drive.frequency) * _TIME + rational(drive.phase), evaluate=False)


def _kinds(name: str) -> tuple[str, str]:
    return FORCES[name] if name in FORCES else KINDS[name]


def _substituted(variant: Variant) -> Variant:
    return replace(variant, derivative="substituted") if variant.form == "parametric" else variant


def _condensed(assembly: Assembly) -> Condensed:
    blocks = {placed.ends.number: assembly.jacobian_blocks(placed) for placed in assembly.placed}
    return condensed(assembly.placed, blocks, assembly.rows)
