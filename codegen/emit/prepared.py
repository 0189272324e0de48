"""Routines on prepared geometry: one routine of a variant computes once what all the others take at every step.

Input: the routines of a variant on ``geometry``. Output: ``<stem>_prepare`` and the same routines on ``prepared``. The
layout of ``prepared`` is told part by part, in the comments and in the manifest.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import groupby

from codegen.emit.routine import Member, Preparation, Routine
from codegen.ir.program import Instruction, Program
from codegen.passes.split_geometry import split_geometry
from codegen.spec.request import PREPARE
from flopcount.count import count

REST = "derived"
"""Name of the values of ``prepared`` that have none of their own."""

_Part = tuple[str, int]
"""Name of a part of ``prepared`` and index in it."""


def prepare_geometry(routines: Sequence[Routine]) -> tuple[Routine, ...]:
    """Split the routines of a variant; without any use of the geometry they are left as they are."""
    split = split_geometry([routine.straight for routine in routines])
    if not split.prepare.outputs[0].values:
        return tuple(routines)
    first = routines[0]
    geometry = first.subject.argument(next(a for a in first.program.arguments if a.name == "geometry"))
    counts = count(split.prepare)
    preparation = Preparation(
        first.subject.routine_stem(PREPARE), counts, tuple(_members(split.prepare, geometry.members))
    )
    prepare = replace(routines[-1], output=PREPARE, program=split.prepare, counts=counts, preparation=preparation)
    steps = (
        replace(routine, program=step, counts=count(step), preparation=preparation)
        for routine, step in zip(routines, split.steps, strict=True)
    )
    return (prepare, *steps)


def _members(prepare: Program, geometry: Sequence[Member]) -> Iterator[Member]:
    """Name the parts of ``prepared``: whole vectors and matrices where all of one is there, else entry by entry."""
    legend = dict(prepare.legend)
    shapes = {name: (shape, meaning) for name, _, shape, meaning in geometry}
    parts = [_part(prepare.instructions[value], geometry) for value in prepare.outputs[0].values]
    offset = 0
    for name, group in groupby(parts, key=lambda part: part[0]):
        indices = [index for _, index in group]
        shape, meaning = shapes.get(name, ((len(indices), 1), legend.get(name, "computed from the geometry")))
        is_whole = name == REST or indices == list(range(shape[0] * shape[1]))
        if is_whole:
            yield name, offset, shape if name != REST else (len(indices), 1), meaning
        else:
            yield from ((f"{name}_{k}", offset + n, (1, 1), f"[{k}] of {meaning}") for n, k in enumerate(indices))
        offset += len(indices)


def _part(instruction: Instruction, geometry: Sequence[Member]) -> _Part:
    if instruction.source is None:
        return instruction.label or (REST, 0)
    _, index = instruction.source
    return next(
        (name, index - offset) for name, offset, shape, _ in geometry if offset <= index < offset + shape[0] * shape[1]
    )
