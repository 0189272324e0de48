"""Differentiate loops: the derivative of every instance, in its rows and columns."""

from __future__ import annotations

from dataclasses import replace

from codegen.ir.looped import Axis, Loop, Looped
from codegen.ir.program import Argument
from codegen.passes.differentiate import differentiate
from codegen.passes.pipeline import simplify


def differentiate_looped(looped: Looped) -> Looped:
    """Give the loops of all partial derivatives of vector outputs by the arguments; simplified."""
    by = looped.used_arguments()
    shapes = {
        f"jac_{name}_{argument.name}": (nrow, argument.length)
        for name, (nrow, _) in looped.shapes.items()
        for argument in by
    }
    loops = tuple(_differentiated(loop, [argument.name for argument in by]) for loop in looped.loops)
    return replace(looped, shapes=shapes, loops=loops)


def _differentiated(loop: Loop, names: list[str]) -> Loop:
    lengths = {argument.name: argument.length for argument in loop.program.arguments}
    directions = [Argument(name, (lengths.get(name, 0), 1)) for name in names]
    program = simplify(differentiate(loop.program, directions))
    outputs: dict[str, tuple[Axis, Axis]] = {
        f"jac_{name}_{direction}": (rows, loop.arguments.get(direction, ()))
        for name, (rows, _) in loop.outputs.items()
        for direction in names
    }
    return replace(loop, program=program, outputs=outputs)
