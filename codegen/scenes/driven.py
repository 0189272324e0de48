"""Drives that have nothing left to move: the joints and the other drives already say how fast their coordinate goes."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from codegen.errors import Mistake, SpecificationError
from codegen.ir.evaluate import evaluate
from codegen.ir.program import Program
from codegen.measure.constraints import Array, Pose
from codegen.measure.rank import null_space
from codegen.mechanics.system import System
from codegen.scenes.state import program_arrays
from codegen.simulate.start import dense

_MOVES = 1e-7
"""A row that changes less, in a direction of length 1 beside the length of the row, does not change."""


def check_drives(system: System, values: Program, pose: Pose) -> None:
    """Refuse drives that depend on the joints and on the drives before them.

    Args:
        system: joints and drives.
        values: ``phi_q`` and what else is evaluated with it.
        pose: at t = 0, all joints closed.

    Raises:
        SpecificationError: all such drives at once.
    """
    if system.drives:
        velocity = [0.0] * len(system.assembly.columns)
        found = evaluate(values, {**program_arrays(system, pose), "velocity": velocity})["phi_q"]
        mistakes = list(_dependent(system, dense(values.output("phi_q"), found)))
        if mistakes:
            raise SpecificationError(mistakes)


def _dependent(system: System, phi_q: Array) -> Iterator[Mistake]:
    first = len(phi_q) - len(system.drives)
    kept, names = phi_q[:first], list[str]()
    for driven, row in zip(system.drives, phi_q[first:], strict=True):
        if np.linalg.norm(row @ null_space(kept)) > _MOVES * np.linalg.norm(row):
            kept = np.vstack([kept, row])
            names.append(f'"{driven.joint}"')
            continue
        others = f" and the drive{'s' * (len(names) > 1)} of {', '.join(names)}" if names else ""
        what = f"nothing is left to move at t = 0: the joints{others} determine its coordinate"
        yield Mistake(f'joint "{driven.joint}": drive', what, "remove a drive, or start from a pose where it can move")
