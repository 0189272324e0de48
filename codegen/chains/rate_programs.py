"""What the compiled motion of a chain evaluates: rows of the cuts without dimension, inertia and forces, all dense."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction

from codegen.chains.partition import Partition
from codegen.dynamics.matrices import Matrices, transposed
from codegen.ir.builder import Builder
from codegen.ir.inline import Entries, inline
from codegen.ir.ops import Op
from codegen.ir.program import Output, Program, Sparsity
from codegen.passes import simplify
from codegen.passes.drop_unused import drop_unused

QUANTITIES = ("phi", "phi_q", "gamma_R", "M", "f_C", "f_G", "D_E", "tau_S", "f_S")
"""Quantities of a chain that they take; those that a chain has not are 0."""


def pose_program(program: Program, part: Partition) -> Program:
    """Give ``phi`` and its derivatives ``phi_w`` and ``phi_v``, lengths divided by the characteristic one.

    Args:
        program: of a chain, with the `QUANTITIES` that it has.
        part: coordinates and rows of the chain.
    """

    def composed(builder: Builder, found: Mapping[str, Entries]) -> dict[str, tuple[Entries, tuple[int, int]]]:
        rows = {row: 1 / float(part.row_units[place]) for row, place in enumerate(part.rows)}
        phi = {(row, 0): _scaled(builder, value, rows[row]) for (row, _), value in found.get("phi", {}).items()}
        named = {"phi": (phi, (len(rows), 1))}
        for name, numbers in (("phi_w", part.w), ("phi_v", part.v)):
            places = {int(k): place for place, k in enumerate(numbers)}
            columns = {
                (row, places[k]): _scaled(builder, value, rows[row] * float(part.units[k]))
                for (row, k), value in found.get("phi_q", {}).items()
                if k in places
            }
            named[name] = columns, (len(rows), len(places))
        return named

    return _composed(program, composed)


def motion_program(program: Program, part: Partition) -> Program:
    """Give ``gamma_R`` without dimension, ``M``, ``f_C`` and ``load``, what else acts along the coordinates.

    Args:
        program: of a chain, with the `QUANTITIES` that it has.
        part: coordinates and rows of the chain.
    """

    def composed(builder: Builder, found: Mapping[str, Entries]) -> dict[str, tuple[Entries, tuple[int, int]]]:
        size, matrices = len(part.units), Matrices(builder)
        rows = {row: 1 / float(part.row_units[place]) for row, place in enumerate(part.rows)}
        gamma = {(row, 0): _scaled(builder, value, rows[row]) for (row, _), value in found.get("gamma_R", {}).items()}
        at_effectors = matrices.product(transposed(found.get("D_E", {})), found.get("f_S", {}))
        load = matrices.total((found["f_G"], found.get("tau_S", {}), at_effectors))
        return {
            "gamma_R": (gamma, (len(rows), 1)),
            "M": (found["M"], (size, size)),
            "f_C": (found["f_C"], (size, 1)),
            "load": (load, (size, 1)),
        }

    return _composed(program, composed)


def _scaled(builder: Builder, value: int, factor: float) -> int:
    return builder.emit(Op.MULTIPLY, builder.constant(Fraction(factor)), value)


def _composed(
    program: Program,
    compose: Callable[[Builder, Mapping[str, Entries]], dict[str, tuple[Entries, tuple[int, int]]]],
) -> Program:
    builder = Builder()
    found = compose(builder, inline(builder, program, builder.input))
    outputs = []
    for name, (entries, shape) in found.items():
        pattern = Sparsity.of_entries(*shape, entries)
        outputs.append(Output(name, pattern, tuple(entries[place] for place in pattern.entries())))
    return _dense(simplify(drop_unused(builder.freeze(program.arguments, tuple(outputs), dict(program.legend)))))


def _dense(program: Program) -> Program:
    """The same outputs with their zeros."""
    builder = Builder()
    found, outputs = inline(builder, program, builder.input), []
    zero = builder.constant(0)
    for output in program.outputs:
        rows, columns = output.sparsity.nrow, output.sparsity.ncol
        full = Sparsity.of_entries(rows, columns, ((i, k) for k in range(columns) for i in range(rows)))
        values = tuple(found[output.name].get(place, zero) for place in full.entries())
        outputs.append(Output(output.name, full, values))
    return builder.freeze(program.arguments, tuple(outputs), dict(program.legend))
