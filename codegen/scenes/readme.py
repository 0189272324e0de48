"""The README of a scene: what was made of it, and why."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from codegen.emit.environment import render
from codegen.emit.package import banner
from codegen.emit.parameters import parameters
from codegen.emit.routine import Parameter, Routine
from codegen.emit.scene_subject import SceneSubject, row_words
from codegen.ir.looped import Loop, Looped
from codegen.measure.evaluations import Measurement
from codegen.passes.flatten import flatten
from codegen.scenes.bill import Bill
from codegen.scenes.bill_text import bill_lines, bill_table
from codegen.scenes.forms import TRIGONOMETRY, Choice, constraint_quantities
from codegen.scenes.markdown import Code, as_code, table
from flopcount.count import count


@dataclass(frozen=True, slots=True)
class Told:
    """What a README tells.

    Attributes:
        subject: the scene.
        routines: everything that is emitted.
        choices: joint name -> its form and why.
        mobility: report on rows and freedom, line by line.
        rows: number of rows before the redundant ones were left out.
        bill: what the scene saves.
        measurement: what the steps of the bill take, if that was asked for.
    """

    subject: SceneSubject
    routines: Sequence[Routine]
    choices: Mapping[str, Choice]
    mobility: Sequence[str]
    rows: int
    bill: Bill
    measurement: Measurement | None


def readme(told: Told, version: str, specification: str, notes: Iterable[str] = ()) -> str:
    """Write the README.

    Args:
        told: what it tells.
        version: of jointgen.
        specification: hash of the scene and of what was asked for.
        notes: sentences on the scene as a whole.
    """
    subject = told.subject
    scene = subject.assembly.scene
    return render(
        "scene/README.md.j2",
        name=scene.name,
        banner=banner(version),
        specification=specification,
        summary=" ".join([_summary(subject), *notes]),
        bodies=table(("body", "in C", "mass, kg"), _bodies(subject)),
        joints=_joints(subject, told.choices),
        is_weighed=any(choice.prices for choice in told.choices.values()),
        trigonometry=TRIGONOMETRY,
        displacements=table(("part", "from", "size", "what"), _displacements(subject)),
        arrays=_arrays(told.routines),
        mobility=[as_code(line) for line in told.mobility],
        left_out=_left_out(subject, told.rows),
        functions=table(("function", "operations"), [(Code(r.symbol), str(r.counts)) for r in told.routines]),
        has_matrices=any(routine.is_matrix for routine in told.routines),
        quantities=", ".join(f"`{name}`" for name in constraint_quantities(scene)),
        instances=_instances(subject, told.routines),
        bill=bill_table(told.bill, told.measurement) if told.bill.items else "",
        bill_lines=bill_lines(told.bill, told.measurement),
    )


def _summary(subject: SceneSubject) -> str:
    assembly = subject.assembly
    bodies, joints = len(assembly.scene.bodies), len(assembly.scene.joints)
    moving = f"{bodies} bodies that move" if bodies > 1 else "1 body that moves"
    plane = "in the plane" if assembly.arrays.is_planar else "in space"
    return (
        f"{moving} {plane}, {joints} joint{'' if joints == 1 else 's'}: {subject.system.row_count} rows over "
        f"{len(assembly.columns)} displacements. Virtual displacements: {subject.axes}."
    )


def _bodies(subject: SceneSubject) -> Iterator[tuple[str, str, str]]:
    for part, number in subject.parts:
        for body in part.assembly.scene.bodies:
            mass = f"{float(body.mass):g}" if body.mass else ""
            yield f"{body.name}{_again(number)}", Code(part.assembly.bodies[body.name]), mass


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
    strides = ", ".join(f"{piece.name} {piece.stride}" for piece in (*flat.inputs, *flat.outputs))
    bodies = ", ".join(body.name for body in subject.part(loop.kind).assembly.scene.bodies)
    words = strides if loop.count > 1 else ""
    return Code(routine.symbol), bodies, str(loop.count), str(count(loop.program)), words


def _joints(subject: SceneSubject, choices: Mapping[str, Choice]) -> str:
    lines = [line for part, number in subject.parts for line in _joint_lines(part, choices, _again(number))]
    return table(("joint", "in C", "type", "bodies", "form", "why", "rows"), lines)


def _joint_lines(subject: SceneSubject, choices: Mapping[str, Choice], again: str) -> Iterable[Sequence[str]]:
    kept = set(subject.assembly.rows)
    for placed in subject.assembly.placed:
        joint, choice = placed.joint, choices[placed.joint.name]
        first = placed.ends.first_row
        rows = [row for row in range(first, first + placed.form.row_count) if row in kept]
        names = row_words(subject.row_names[row][1] for row in rows) or "none"
        form = " ".join(word for word in (choice.variant.form, choice.variant.rows) if word)
        name = f"{joint.name}{again}"
        yield name, Code(placed.ends.name), joint.type, " - ".join(joint.bodies), form, choice.why, names


def _displacements(subject: SceneSubject) -> Iterator[tuple[str, str, str, str]]:
    members, repeats = subject.parts_of_displacements
    for name, offset, shape, meaning in members:
        yield Code(name), str(offset), _size(shape), meaning + _times(repeats, offset)


def _times(repeats: Mapping[int, tuple[int, int]], offset: int) -> str:
    number, stride = repeats.get(offset, (1, 0))
    return f"; {number} times, every {stride} entries" if number > 1 else ""


def _left_out(subject: SceneSubject, rows: int) -> str:
    assembly = subject.assembly
    zero, redundant = assembly.all_rows - rows, rows - len(assembly.rows)
    parts = [f"{zero} identically zero"] if zero else []
    parts += [f"{redundant} redundant"] if redundant else []
    many = zero + redundant
    if not parts:
        return ""
    return (
        f"{many} of the {assembly.all_rows} rows of the joints {'is' if many == 1 else 'are'} not in the routines: "
        f"{' and '.join(parts)}."
    )


def _arrays(routines: Sequence[Routine]) -> str:
    """Every argument and output once, part by part; parts that are those of an array before are not told again."""
    lines: list[tuple[str, ...]] = []
    told: dict[str, tuple[object, ...]] = {}
    for routine in routines:
        for parameter in parameters(routine, dense=False):
            if parameter.name in told:
                continue
            parts = tuple((offset, shape, meaning) for _, offset, shape, meaning in parameter.members)
            same = next((name for name, others in told.items() if parts and others == parts), "")
            told[parameter.name] = parts
            shape = "x".join(str(size) for size in parameter.shape if size != 1) or "1"
            words = f"{parameter.frame}; {parameter.unit}" + (f"; parts as of {same}" if same else "")
            lines.append((Code(parameter.name), "", "", shape, words))
            lines += [] if same else _parts(parameter)
    return table(("array", "part", "from", "size", "what"), lines)


def _parts(parameter: Parameter) -> Iterator[tuple[str, ...]]:
    for name, offset, shape, meaning in parameter.members:
        yield "", Code(name), str(offset), _size(shape), meaning + _times(parameter.repeats, offset)


def _size(shape: tuple[int, int]) -> str:
    rows, columns = shape
    return str(rows) if columns == 1 else f"{rows}x{columns}"
