"""Derivatives of a system's programs by displacements and velocities, forward through the program.

For quantities of which no derivative is derived symbolically: the seed of an entry of ``A`` is that of ``delta A = A
delta pi~``.
"""

from __future__ import annotations

from codegen.ir.builder import Builder
from codegen.ir.ops import Op
from codegen.ir.program import Argument, Output, Program
from codegen.mechanics.arrays import Arrays
from codegen.mechanics.system import System
from codegen.passes.differentiate import Gradient, differentiate


def by_motion(program: Program, system: System) -> Program:
    """Differentiate the columns of a program by displacements (``_q``) and by velocities (``_v``); not simplified.

    Args:
        program: of a system; its outputs are columns.
        system: for the layout of the arguments.

    Returns:
        Outputs ``NAME_q`` and ``NAME_v``, [rows, displacements].
    """
    arrays, bodies = system.assembly.arrays, len(system.assembly.scene.bodies)
    size = len(system.assembly.columns)

    def seed(builder: Builder, argument: str, index: int) -> Gradient:
        match argument:
            case "r":
                body, k = divmod(index, arrays.position)
                return {("q", arrays.displacements * body + k): builder.constant(1)}
            case "A":
                return _turned(builder, arrays, index)
            case "alpha":
                return {("q", arrays.displacements * bodies + index): builder.constant(1)}
            case "velocity":
                return {("v", index): builder.constant(1)}
        return {}

    derivative = differentiate(program, (Argument("q", (size, 1)), Argument("v", (size, 1))), seed)
    outputs = (Output(_name(output.name), output.sparsity, output.values) for output in derivative.outputs)
    return Program(derivative.arguments, derivative.instructions, tuple(outputs), derivative.legend)


def _turned(builder: Builder, arrays: Arrays, index: int) -> Gradient:
    """``delta A_ij = A_im delta pi_n - A_in delta pi_m`` with (j, m, n) in order; in the plane ``(-A_i2, A_i1)``."""
    body, place = divmod(index, arrays.attitude)
    first = arrays.displacements * body
    if arrays.is_planar:
        column, row = divmod(place, 2)
        other = builder.input("A", 4 * body + 2 * (1 - column) + row)
        return {("q", first + 2): other if column == 0 else builder.emit(Op.NEGATE, other)}
    column, row = divmod(place, 3)
    m, n = (column + 1) % 3, (column + 2) % 3
    beside, behind = (builder.input("A", 9 * body + 3 * k + row) for k in (m, n))
    return {("q", first + 3 + n): beside, ("q", first + 3 + m): builder.emit(Op.NEGATE, behind)}


def _name(jacobian: str) -> str:
    """``jac_gamma_q`` is ``gamma_q``."""
    return jacobian.removeprefix("jac_")
