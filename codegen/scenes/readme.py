"""The README of a scene: what was made of it, and why."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence

from codegen.emit.environment import render
from codegen.emit.package import banner
from codegen.emit.parameters import parameters
from codegen.emit.routine import Routine
from codegen.emit.scene_subject import SceneSubject
from codegen.scenes.bill import Item
from codegen.scenes.forms import Choice, constraint_quantities


def readme(
    subject: SceneSubject,
    routines: Sequence[Routine],
    choices: Mapping[str, Choice],
    mobility: Sequence[str],
    items: Sequence[Item],
    version: str,
    specification: str,
    notes: Iterable[str] = (),
) -> str:
    """Write the README.

    Args:
        subject: the scene.
        routines: everything that is emitted.
        choices: joint name -> its form and why.
        mobility: report on rows and freedom, line by line.
        items: the bill.
        version: of jointgen.
        specification: hash of the scene and of what was asked for.
        notes: sentences on the scene as a whole.
    """
    assembly = subject.assembly
    scene = assembly.scene
    dropped = len(assembly.dropped)
    return render(
        "scene/README.md.j2",
        name=scene.name,
        banner=banner(version),
        specification=specification,
        summary=" ".join([_summary(subject), *notes]),
        bodies=table(("body", "in C", "mass, kg"), _bodies(subject)),
        joints=_joints(subject, choices),
        arrays=_arrays(routines),
        mobility=[escaped(line, code=True) for line in mobility],
        dropped=f"{dropped} of {assembly.all_rows} rows of the joints are not in the routines." if dropped else "",
        functions=table(
            ("function", "operations"), [(f"`{routine.symbol}`", str(routine.counts)) for routine in routines]
        ),
        quantities=", ".join(f"`{name}`" for name in constraint_quantities(scene)),
        bill=_bill(items),
        measured="",
    )


def _summary(subject: SceneSubject) -> str:
    assembly = subject.assembly
    motion = "in the plane" if assembly.arrays.is_planar else "in space"
    return (
        f"{len(assembly.scene.bodies)} bodies that move {motion}, {len(assembly.scene.joints)} joints: "
        f"{len(assembly.rows)} rows over {len(assembly.columns)} displacements. Virtual displacements: {subject.axes}."
    )


def _bodies(subject: SceneSubject) -> Iterable[tuple[str, str, str]]:
    for body in subject.assembly.scene.bodies:
        yield body.name, subject.assembly.bodies[body.name], f"{float(body.mass):g}"


def _joints(subject: SceneSubject, choices: Mapping[str, Choice]) -> str:
    kept = set(subject.assembly.rows)
    lines = []
    for placed in subject.assembly.placed:
        first = placed.ends.first_row
        rows = range(first, first + placed.form.row_count)
        names = ", ".join(subject.row_names[row][1] for row in rows if row in kept) or "none"
        choice = choices[placed.joint.name]
        between = " - ".join(placed.joint.bodies)
        lines.append((placed.joint.name, placed.joint.type, between, choice.variant.form, choice.why, names))
    return table(("joint", "type", "bodies", "form", "why", "rows"), lines)


def _arrays(routines: Sequence[Routine]) -> str:
    """Every argument and output once, part by part."""
    lines: dict[tuple[str, str], tuple[str, str, str, str]] = {}
    for routine in routines:
        for parameter in parameters(routine, dense=False):
            shape = "x".join(str(size) for size in parameter.shape if size != 1 or parameter.shape == (1, 1))
            words = f"{parameter.frame}; {parameter.unit}"
            lines.setdefault((parameter.name, ""), (f"`{parameter.name}`", "", shape, words))
            for name, offset, (rows, columns), meaning in parameter.members:
                size = str(rows) if columns == 1 else f"{rows}x{columns}"
                lines.setdefault((parameter.name, name), ("", f"`{name}` from {offset}", size, meaning))
    return table(("array", "part", "size", "what"), lines.values())


def _bill(items: Sequence[Item]) -> str:
    lines, before = [], items[0].operations
    for item in items:
        saved = before - item.operations
        lines.append((item.words, str(item.operations), str(saved) if item is not items[0] else ""))
        before = item.operations
    return table(("step", "operations", "saved"), lines)


def table(head: Sequence[str], lines: Iterable[Sequence[str]]) -> str:
    """Write a table; text from a scene file stays text."""
    rows = [head, ["---"] * len(head), *([escaped(cell) for cell in line] for line in lines)]
    return "\n" + "\n".join(f"| {' | '.join(row)} |" for row in rows) + "\n"


def escaped(text: str, code: bool = False) -> str:
    """Take the meaning that Markdown gives to signs away, but for code."""
    plain = " ".join(text.split())
    if code or plain.startswith("`"):
        return plain
    return re.sub(r"([\\`*_\[\]<>|#!])", r"\\\1", plain)
