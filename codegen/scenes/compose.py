"""The routines of a scene from those of its kinds of sections: each kind is lowered once."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from codegen.ir.looped import GEOMETRY, Loop, Looped
from codegen.ir.ops import Constant
from codegen.ir.program import Argument, Program
from codegen.mechanics.plan import Plan, Series
from codegen.mechanics.system import System
from codegen.passes import simplify
from codegen.passes.split_geometry import split_geometry
from codegen.passes.unroll import with_constants


def compose(plan: Plan, lowered: Callable[[System], Program]) -> Looped:
    """Compose a routine.

    Args:
        plan: the scene.
        lowered: gives the program of one section.
    """
    programs = [lowered(system) for system in plan.kinds]
    loops = tuple(_loop(programs[series.kind], series) for series in plan.series)
    names = [output.name for output in programs[0].outputs]
    arguments = dict.fromkeys(argument.name for program in programs for argument in program.arguments)
    return Looped(
        tuple(Argument(name, (plan.argument_length(name), 1)) for name in arguments if name != GEOMETRY),
        {name: plan.output_shape(name) for name in names},
        loops,
        tuple({name: words for program in programs for name, words in program.legend}.items()),
    )


def _loop(program: Program, series: Series) -> Loop:
    step, table = _tabled(program, series.geometry)
    arguments = {a.name: series.argument(a.name) for a in step.used_arguments() if a.name != GEOMETRY}
    outputs = {output.name: series.output(output.name) for output in step.outputs}
    return Loop(step, series.kind, len(series.sections), arguments, outputs, table)


def _tabled(
    program: Program, geometry: tuple[tuple[Constant, ...], ...]
) -> tuple[Program, tuple[tuple[Constant, ...], ...]]:
    """Compute what depends on the geometry alone beforehand, exactly; the table holds what is left to read."""
    if GEOMETRY not in (argument.name for argument in program.used_arguments()):
        return program, tuple(() for _ in geometry)
    split = split_geometry([program], (GEOMETRY,), GEOMETRY)
    rows = [_evaluated(split.prepare, values) for values in geometry]
    if any(row is None for row in rows):
        return program, geometry
    return split.steps[0], tuple(row for row in rows if row is not None)


def _evaluated(program: Program, values: Sequence[Constant]) -> tuple[Constant, ...] | None:
    """The exact values of a program of the geometry; None where one is no rational times a power of pi."""
    known = simplify(with_constants(program, values))
    found = [known.instructions[value].constant for value in known.outputs[0].values]
    return tuple(value for value in found if value is not None) if None not in found else None
