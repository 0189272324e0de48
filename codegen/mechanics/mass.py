"""The mass matrix of a scene: constant and block diagonal."""

from __future__ import annotations

from fractions import Fraction

from codegen.ir.ops import Constant, Op
from codegen.ir.program import Argument, Instruction, Output, Program, Sparsity
from codegen.mechanics.arrays import Arrays
from codegen.spec.scene import Body, Scene


def mass(scene: Scene, arrays: Arrays, size: int, arguments: tuple[Argument, ...] = ()) -> Program:
    """Give ``mass``: ``m I`` and the inertia about the centre of mass of each body; zero for joint coordinates.

    It is the same where virtual translations are in body axes: there it multiplies the classical acceleration ``A^T
    rddot``.

    Args:
        scene: the bodies.
        arrays: layout of the bodies.
        size: number of displacements, those of joint coordinates included.
        arguments: of the signature; none is read.
    """
    entries = {place: value for k, body in enumerate(scene.bodies) for place, value in _of_body(body, arrays, k)}
    sparsity = Sparsity.of_entries(size, size, entries)
    values = [entries[place] for place in sparsity.entries()]
    known = list(dict.fromkeys(values))
    instructions = tuple(Instruction(Op.CONSTANT, constant=Constant(value)) for value in known)
    return Program(arguments, instructions, (Output("mass", sparsity, tuple(known.index(v) for v in values)),))


def _of_body(body: Body, arrays: Arrays, number: int) -> list[tuple[tuple[int, int], Fraction]]:
    first = arrays.displacements * number
    axes = (2,) if arrays.is_planar else (0, 1, 2)
    turning = first + arrays.displacements - len(axes)
    found = [((k, k), body.mass) for k in range(first, turning)]
    for k, row in enumerate(axes):
        for n, column in enumerate(axes):
            if body.inertia[row][column]:
                found.append(((turning + k, turning + n), body.inertia[row][column]))
    return found
