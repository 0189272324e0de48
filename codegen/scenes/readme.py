"""The README of a scene: what was made of it, and why."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence

from codegen.emit.environment import render
from codegen.emit.package import banner
from codegen.emit.parameters import parameters
from codegen.emit.routine import Routine
from codegen.emit.scene_subject import SceneSubject
from codegen.ir.looped import Loop, Looped
from codegen.passes.flatten import flatten
from codegen.scenes.bill import Item
from codegen.scenes.forms import Choice, constraint_quantities
from flopcount.count import count


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
        instances=_instances(subject, routines),
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
    for part, number in subject.parts:
        for body in part.assembly.scene.bodies:
            yield f"{body.name}{_again(number)}", part.assembly.bodies[body.name], f"{float(body.mass):g}"


def _again(number: int) -> str:
    return f" and {number - 1} more" if number > 1 else ""


def _instances(subject: SceneSubject, routines: Sequence[Routine]) -> str:
    """The loops of every routine: how many instances, and entries of each array from one to the next."""
    if subject.plan is None:
        return ""
    lines = []
    for routine in routines:
        if isinstance(routine.program, Looped):
            lines += [_loop(subject, routine, routine.program, loop) for loop in routine.program.loops]
    return table(("function", "instance", "how many", "operations of one", "entries from one to the next"), lines)


def _loop(subject: SceneSubject, routine: Routine, looped: Looped, loop: Loop) -> tuple[str, str, str, str, str]:
    flat = flatten(looped, loop)
    strides = ", ".join(f"`{piece.name}` {piece.stride}" for piece in (*flat.inputs, *flat.outputs))
    bodies = ", ".join(body.name for body in subject.part(loop.kind).assembly.scene.bodies)
    words = strides if loop.count > 1 else ""
    return f"`{routine.symbol}`", bodies, str(loop.count), str(count(loop.program)), words


def _joints(subject: SceneSubject, choices: Mapping[str, Choice]) -> str:
    lines = [line for part, number in subject.parts for line in _joint_lines(part, choices, _again(number))]
    return table(("joint", "type", "bodies", "form", "why", "rows"), lines)


def _joint_lines(subject: SceneSubject, choices: Mapping[str, Choice], again: str) -> Iterable[Sequence[str]]:
    kept = set(subject.assembly.rows)
    for placed in subject.assembly.placed:
        first = placed.ends.first_row
        rows = range(first, first + placed.form.row_count)
        names = ", ".join(subject.row_names[row][1] for row in rows if row in kept) or "none"
        choice = choices[placed.joint.name]
        between = " - ".join(placed.joint.bodies)
        yield f"{placed.joint.name}{again}", placed.joint.type, between, choice.variant.form, choice.why, names


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
                number, stride = parameter.repeats.get(offset, (1, 0))
                again = f"; {number} times, every {stride} entries" if number > 1 else ""
                lines.setdefault((parameter.name, name), ("", f"`{name}` from {offset}", size, meaning + again))
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
