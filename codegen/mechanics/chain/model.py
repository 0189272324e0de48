"""A chain as a program: arguments, the quantities that are asked for, their rows. Not simplified."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import sympy

from codegen.ir.lower.staged import Stages
from codegen.ir.program import Program
from codegen.mechanics.chain.applied import Applied
from codegen.mechanics.chain.bias import Bias
from codegen.mechanics.chain.closure import Closure, Loop
from codegen.mechanics.chain.composite import Composite
from codegen.mechanics.chain.geometry import Geometry
from codegen.mechanics.chain.recursion import Recursion, Twist, Wrench
from codegen.mechanics.chain.tree import ROOT, Tree
from codegen.mechanics.chain.vectors import (
    ZERO,
    Rows,
    Vector,
    added,
    negative,
    rows,
    times,
    transposed,
    vector,
)
from codegen.spec.chain import Chain

ROW_NAMES = ("p_x", "p_y", "p_z", "2 e_x", "2 e_y", "2 e_z")
"""Rows of a cut."""


def kept_rows(chain: Chain) -> tuple[int, ...]:
    """Rows of all cuts, six each, that a coordinate changes; the others are constant."""
    model = Model(chain)
    return tuple(row for row in range(6 * len(chain.cuts)) if any(model.jacobian[row]))


def chain_program(chain: Chain, names: Iterable[str], progressive: bool = True) -> Program:
    """The program of quantities of a chain, not simplified.

    Args:
        chain: the chain.
        names: of `codegen.spec.chain.CHAIN_QUANTITIES`, in the order of the outputs; or ``tau_S`` and ``f_S``, which
            are tau_A and f_A with those of the forces that switch that ``on`` says, 1 or 0 for each.
        progressive: how M is summed, see `codegen.mechanics.chain.composite`.
    """
    model = Model(chain, progressive)
    for name in names:
        model.add(name)
    return model.stages.program()


@dataclass(frozen=True)
class _Base:
    """Motion of the base: rotation and position in the world, velocity and acceleration in its own axes."""

    R: Rows
    p: Vector
    twist: Twist


class Model:
    """The quantities of a chain as outputs of stages.

    Args:
        chain: the chain.
        progressive: how M is summed.

    Attributes:
        stages: what has been derived.
    """

    def __init__(self, chain: Chain, progressive: bool = True) -> None:
        self._chain, self._progressive = chain, progressive
        self._tree, self.stages = Tree(chain), Stages()
        size = len(chain.links)
        argument = self.stages.argument
        self._q, self._qd, self._qdd = argument("q", size), argument("qd", size), argument("qdd", size)
        self._f_R = argument("f_R", 6 * len(chain.cuts)) if chain.cuts else sympy.zeros(0, 1)
        switched = len(chain.conditions)
        self._on = argument("on", switched) if switched else sympy.zeros(0, 1)
        self._f_E = argument("f_E", 6 * len(chain.effectors)) if chain.effectors else sympy.zeros(0, 1)
        self._base = self._moving_base() if chain.base == "moving" else _still()
        self._world = Geometry(self._tree, self.stages, self._q)

    def add(self, name: str) -> None:
        """Add a quantity to the outputs."""
        self.stages.output(name, getattr(self, f"_{name}")())

    def _moving_base(self) -> _Base:
        T = self.stages.argument("T_0", 3, 4)
        v, vd = self.stages.argument("v_0", 6), self.stages.argument("vd_0", 6)
        R = rows((T[i, k] for k in range(3)) for i in range(3))
        twist = Twist(vector(v[:3]), vector(v[3:]), vector(vd[:3]), vector(vd[3:]))
        return _Base(R, vector(T[i, 3] for i in range(3)), twist)

    @cached_property
    def _gravity(self) -> Vector:
        """Acceleration of gravity in the axes of the base."""
        g = vector(map(sympy.Rational, self._chain.gravity))
        matrix = sympy.Matrix(times(transposed(self._base.R), g))
        return vector(self.stages.stage("g_0", matrix, "gravity in the axes of the base"))

    @cached_property
    def _bias(self) -> Bias:
        twist = self._base.twist
        return Bias(self._world, self._qd, twist.w, twist.e, twist.a)

    @cached_property
    def _composite(self) -> Composite:
        return Composite(self._world, self._bias, self._progressive)

    @cached_property
    def _closures(self) -> list[Closure]:
        return [Closure(self._loop(k)) for k in range(len(self._chain.cuts))]

    def _loop(self, k: int) -> Loop:
        cut = self._tree.cuts[k]
        root = self._tree.loop_root(cut)
        geometry = self._world if root == ROOT else Geometry(self._tree, self.stages, self._q, root, f"loop{k + 1}_")
        is_shared = root == ROOT and self._chain.base == "fixed"
        bias = self._bias if is_shared else Bias(geometry, self._qd, prefix="r")
        return Loop(k, geometry, bias, *cut)

    # --- rows of the cuts

    @cached_property
    def jacobian(self) -> list[list[Any]]:
        """J, all six rows of each cut."""
        return self._of_columns([closure.columns() for closure in self._closures])

    def _of_columns(self, found: Sequence[dict[int, tuple[Vector, Vector]]]) -> list[list[Any]]:
        size = len(self._chain.links)
        return [
            [(*columns[k][0], *columns[k][1])[row] if k in columns else sympy.S.Zero for k in range(size)]
            for columns in found
            for row in range(6)
        ]

    def _kept(self, values: Sequence[Any]) -> sympy.Matrix:
        """The rows that a coordinate changes."""
        return sympy.Matrix([values[row] for row, entries in enumerate(self.jacobian) if any(entries)])

    def _J(self) -> sympy.Matrix:
        return self._kept(self.jacobian)

    def _phi(self) -> sympy.Matrix:
        return self._kept([value for closure in self._closures for part in closure.constraint() for value in part])

    def _phi_q(self) -> sympy.Matrix:
        return self._kept(self._of_columns([closure.derivative() for closure in self._closures]))

    def _gamma_R(self) -> sympy.Matrix:
        return self._kept([value for closure in self._closures for part in closure.gamma() for value in part])

    def _closure(self) -> sympy.Matrix:
        poses = [closure.pose() for closure in self._closures]
        return sympy.Matrix([value for R, p in poses for column in (*transposed(R), p) for value in column])

    # --- frames

    def _frames(self) -> sympy.Matrix:
        found: list[Any] = []
        for node in self._tree.nodes:
            axes, origin = self._world.axes(node.number), self._world.position(node.number)
            turned = [times(self._base.R, axis) for axis in axes]
            found += [value for axis in turned for value in axis]
            found += added(self._base.p, times(self._base.R, origin))
        return sympy.Matrix(found)

    def _D_E(self) -> sympy.Matrix:
        return sympy.Matrix([row for node in self._tree.effectors for row in self._effector_jacobian(node.number)])

    def _effector_jacobian(self, number: int) -> list[list[Any]]:
        axes, size = self._world.axes(number), len(self._chain.links)
        columns = [[sympy.S.Zero] * 6 for _ in range(size)]
        for node in self._tree.path(self._tree.nodes[number].parent):
            linear, angular = self._world.column(node, number)
            columns[node.number] = [*times(axes, linear), *times(axes, angular)]
        return [list(row) for row in zip(*columns, strict=True)]

    def _effectors(self) -> sympy.Matrix:
        recursion = self._recursion(self._base.twist, "E")
        twists = [recursion.twist(node.number) for node in self._tree.effectors]
        return sympy.Matrix([value for t in twists for part in (t.v, t.w, t.a, t.e) for value in part])

    # --- dynamics

    def _M(self) -> sympy.Matrix:
        rotors = sympy.diag(*(sympy.Rational(link.rotor) for link in self._chain.links))
        return self._composite.matrix() + rotors

    def _f_C(self) -> sympy.Matrix:
        return sympy.Matrix(self._composite.bias())

    def _f_G(self) -> sympy.Matrix:
        return sympy.Matrix(self._composite.gravity(self._gravity))

    def _tau_A(self) -> sympy.Matrix:
        return sympy.Matrix(self._applied.on_joints())

    def _f_A(self) -> sympy.Matrix:
        return sympy.Matrix(self._applied.at_effectors())

    def _tau_S(self) -> sympy.Matrix:
        """Like tau_A, with the forces that switch."""
        return sympy.Matrix(self._switched.on_joints())

    def _f_S(self) -> sympy.Matrix:
        """Like f_A, with the forces that switch."""
        return sympy.Matrix(self._switched.at_effectors())

    @cached_property
    def _applied(self) -> Applied:
        return Applied(self._world, self._q, self._qd, self._base.R)

    @cached_property
    def _switched(self) -> Applied:
        return Applied(self._world, self._q, self._qd, self._base.R, self._on)

    def _wrenches(self) -> sympy.Matrix:
        twist = self._base.twist
        lifted = Twist(twist.v, twist.w, added(twist.a, negative(self._gravity)), twist.e)
        found = self._recursion(lifted, "W").wrenches(self._outer_wrenches())
        return sympy.Matrix([value for F, N in found for value in (*F, *N)])

    def _outer_wrenches(self) -> dict[int, Wrench]:
        """What acts on the chain at the frames of cuts and effectors."""
        found: dict[int, Wrench] = {}
        for k, (C, R) in enumerate(self._tree.cuts):
            force, moment = vector(self._f_R[6 * k : 6 * k + 3]), vector(self._f_R[6 * k + 3 : 6 * k + 6])
            found |= {C.number: (negative(force), negative(moment)), R.number: (force, moment)}
        for k, node in enumerate(self._tree.effectors):
            found[node.number] = vector(self._f_E[6 * k : 6 * k + 3]), vector(self._f_E[6 * k + 3 : 6 * k + 6])
        return found

    def _recursion(self, base: Twist, prefix: str) -> Recursion:
        return Recursion(self._tree, self.stages, (self._q, self._qd, self._qdd), base, prefix)


def _still() -> _Base:
    return _Base(rows([(1, 0, 0), (0, 1, 0), (0, 0, 1)]), ZERO, Twist(ZERO, ZERO, ZERO, ZERO))
