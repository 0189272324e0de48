"""Slider-cranks in a row: their routine in both shapes, and the library's routines for the joints of one of them."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import Any

from codegen.dynamics.layout import layout
from codegen.emit.c import entries
from codegen.emit.routine import Parameter, Routine
from codegen.emit.scene_subject import SceneSubject
from codegen.ir.looped import Looped
from codegen.ir.program import Output, Result
from codegen.mechanics.assembly import Assembly
from codegen.mechanics.plan import plan
from codegen.mechanics.system import System
from codegen.models import model
from codegen.scenes import read
from codegen.scenes.compose import compose
from codegen.scenes.generate import judge
from codegen.scenes.loops import decided
from codegen.scenes.numbers import rows_of
from codegen.scenes.programs import program
from codegen.spec.markers import markers
from codegen.spec.request import QUANTITIES
from codegen.spec.scene import GROUND
from codegen.spec.scene_file.copies import copied
from flopcount.count import count

ENGINE = Path(__file__).resolve().parents[2] / "examples" / "in_line_engine.toml"
SHAPES = {"straight": "never", "loops": "auto"}
"""Name of a shape -> the option that gives it."""

STEP = Fraction(1, 10)
"""m, from one set to the next along z."""


@dataclass(frozen=True)
class Emitted:
    """The routine of some sets in one shape.

    Attributes:
        shape: of `SHAPES`.
        symbol: of the function.
        seconds: of processor time from the judged scene to the text in C.
        operations: of the routine.
        parameters: of the function.
        text: in C.
    """

    shape: str
    symbol: str
    seconds: float
    operations: int
    parameters: tuple[Parameter, ...]
    text: str


def engine() -> Assembly:
    """One slider-crank with its forms and rows."""
    scene, _ = read(ENGINE, 1)
    return judge(scene).assembly


def sets(one: Assembly, number: int) -> Assembly:
    """Several of them, each with the forms and rows of the first."""
    scene = copied(one.scene, number, (Fraction(0), Fraction(0), STEP))
    forms = [one.forms[joint.name] for joint in one.scene.joints]
    named = {joint.name: forms[k % len(forms)] for k, joint in enumerate(scene.joints)}
    dropped = frozenset(one.all_rows * k + row for k in range(number) for row in one.dropped)
    return Assembly(scene, named, dropped)


def emitted(assembly: Assembly, shape: str) -> Emitted:
    """Write the routine of all quantities."""
    start = time.process_time()
    named = replace(assembly, scene=replace(assembly.scene, name=shape))
    planned = plan(named)
    found = decided(compose(planned, lambda system: program(system, QUANTITIES)), SHAPES[shape])
    system = System(named)
    names = tuple((j.name, row.name) for j in named.scene.joints for row in rows_of(named.forms[j.name]))
    subject = SceneSubject(system, layout(system, "index2"), names, planned if isinstance(found, Looped) else None)
    (stored, _) = entries(Routine(subject, "all", found, count(found), ""))
    text = f'#include "jointgen/jg_real.h"\n\n{stored.signature};\n\n{stored.text}'
    seconds = time.process_time() - start
    return Emitted(shape, stored.symbol, seconds, count(found).total, stored.parameters, text)


# --- the library, joint by joint


def library_joints(one: Assembly) -> list[dict[str, Any]]:
    """What the driver must know of each joint of a set: its routine, its geometry and where its entries go."""
    whole = {output.name: output for output in program(System(one), QUANTITIES).outputs}
    numbers = {body.name: k for k, body in enumerate(one.scene.bodies)} | {GROUND: -1}
    kept = {row: k for k, row in enumerate(one.rows)}
    joints = []
    for number, placed in enumerate(one.placed):
        i, j = (numbers[name] for name in placed.joint.bodies)
        rows = [kept.get(placed.ends.first_row + k, -1) for k in range(placed.form.row_count)]
        columns = [6 * body + k if body >= 0 else -1 for body in (i, j) for k in range(6)]
        outputs = model(one.forms[placed.joint.name]).program(QUANTITIES).outputs
        joints.append(
            {
                "number": number,
                "symbol": f"jg_{placed.joint.type}_conventional_all",
                "i": i,
                "j": j,
                "rows": rows,
                "geometry": [repr(float(x)) for marker in markers(placed.joint, "conventional") for x in _laid(marker)],
                "lengths": {output.name: len(output.values) for output in outputs},
                "maps": {output.name: _map(output, whole[output.name], rows, columns) for output in outputs},
            }
        )
    return joints


def _laid(marker: Any) -> Sequence[Fraction]:
    return [*marker.point, *(x for column in zip(*marker.axes, strict=True) for x in column)]


def _map(output: Output, whole: Result, rows: Sequence[int], columns: Sequence[int]) -> list[int]:
    """Place of each nonzero of a joint among those of the set; -1 for what the set does not have."""
    places = {place: k for k, place in enumerate(whole.sparsity.entries())}
    down = columns if output.name == "phi_q_t_lambda_q" else rows
    across = columns if output.sparsity.ncol > 1 else [0]
    return [places.get((down[row], across[column]), -1) for row, column in output.sparsity.entries()]
