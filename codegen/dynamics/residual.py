"""Residual ``F(t, y, ydot)`` of the equations of motion.

Rows as the entries of `codegen.dynamics.layout.Layout`, with ``c = phi_q^T mu``:

- positions: ``rdot - v - c_r``, ``pdot - G(p)^T (omega + c_pi) / 2 - NORM_DAMPING (1 - p . p) p`` (in the plane
  ``angle' - omega - c_pi``), ``alphadot - w - c_alpha``
- velocities: ``M a + phi_q^T lambda - force``
- multipliers: ``phi`` (index 2) or ``phi_q a - gamma + 2 beta (phi_q v + phi_t) + beta^2 phi`` (index 1, without ``c``)
- corrections: ``phi_q v + phi_t`` (index 2)

``mu`` vanishes on solutions (Gear, Gupta and Leimkuhler 1985). Where the programs of a system have translations in body
axes, so have the rows of the velocities.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from codegen.dynamics.attitude import norm_squared, rate_map
from codegen.dynamics.condensation import completed, without_condensed
from codegen.dynamics.layout import Layout
from codegen.dynamics.matrices import moved, transposed
from codegen.dynamics.state import State, Values
from codegen.ir.builder import Builder
from codegen.ir.inline import Entries
from codegen.ir.ops import Op
from codegen.ir.program import Argument, Output, Program, Sparsity
from codegen.mechanics.system import System
from codegen.spec.scene import Drive

NORM_DAMPING = Fraction(1)
"""1/s: the norm of Euler parameters goes back to 1 as ``exp(-2 t)``; attitudes do not depend on it."""

INDEX2 = ("phi", "phi_q_v", "phi_q_t_lambda", "force")
INDEX1 = ("phi", "phi_q_v", "phi_q", "gamma", "phi_q_t_lambda", "force")
"""Quantities that a residual takes."""


def residual(system: System, layout: Layout, program: Program, mass: Program, beta: Fraction) -> Program:
    """Compose the residual; not simplified.

    Args:
        system: the mechanism.
        layout: of the state; it says which index.
        program: of `INDEX2` or `INDEX1`.
        mass: `codegen.mechanics.mass.mass`.
        beta: of Baumgarte's stabilisation, 1/s.

    Returns:
        A program of ``t``, ``y``, ``ydot`` and ``revolutions`` with the output ``residual``.
    """
    state = completed(system, layout, program)
    found = state.evaluated(program)
    parts = [moved(_positions(state, program), state.layout.positions.start, 0)]
    parts.append(moved(_motion(state, found, mass), state.layout.velocities.start, 0))
    drift = state.matrices.total((found["phi_q_v"], _phi_t(state)))
    if "gamma" in found:
        parts.append(moved(_accelerations(state, found, drift, beta), state.layout.multipliers.start, 0))
    else:
        parts.append(moved(found["phi"], state.layout.multipliers.start, 0))
        parts.append(moved(drift, state.layout.corrections.start, 0))
    rows = without_condensed(state, {place: value for part in parts for place, value in part.items()})
    return state.builder.freeze(arguments(system, layout), (column(state, "residual", rows),))


def arguments(system: System, layout: Layout, *more: Argument) -> tuple[Argument, ...]:
    """Arguments of the programs over a state."""
    others = ("revolutions", "geometry")
    kept = (argument for argument in system.arguments() if argument.name in others and argument.length)
    time, size = Argument("t", (1, 1)), (layout.size, 1)
    return (time, Argument("y", size), Argument("ydot", size), *more, *kept)


def column(state: State, name: str, rows: Entries) -> Output:
    """A full column."""
    size = state.given.size
    zero = state.builder.constant(0)
    full = Sparsity.of_entries(size, 1, ((k, 0) for k in range(size)))
    return Output(name, full, tuple(rows.get((k, 0), zero) for k in range(size)))


def _positions(state: State, program: Program) -> Entries:
    """The rows of the positions."""
    emit = state.builder.emit
    corrected = dict(enumerate(state.y(state.layout.velocities)))
    if state.layout.corrections:
        corrections = state.evaluated(program, multipliers=state.y(state.layout.corrections))["phi_q_t_lambda"]
        in_world = state.matrices.product(transposed(state.axes_of_velocity), corrections)
        for (k, _), value in in_world.items():
            corrected[k] = emit(Op.ADD, corrected[k], value)
    found: Entries = {}
    rates = state.rates(state.layout.positions)
    for place, velocity in _position_rates(state, list(corrected.values())):
        found[place, 0] = emit(Op.SUBTRACT, rates[place], velocity)
    return found


def _position_rates(state: State, velocity: Values) -> Iterator[tuple[int, int]]:
    """Places of the positions and their rates."""
    moves = state.arrays.displacements
    for body in state.bodies:
        own = velocity[moves * body : moves * (body + 1)]
        yield from ((state.stride * body + k, own[k]) for k in range(state.axes))
        yield from zip(state.attitude_places(body), _attitude_rates(state, body, own[state.axes :]), strict=True)
    yield from zip(state.alpha_places, velocity[moves * len(state.bodies) :], strict=True)


def _attitude_rates(state: State, body: int, omega: Values) -> Values:
    """``G^T omega / 2 + NORM_DAMPING (1 - p . p) p``, or omega in the plane."""
    if state.is_planar:
        return omega
    builder, matrices = state.builder, state.matrices
    p = state.y(state.attitude_places(body))
    half = matrices.scaled(builder.constant(Fraction(1, 2)), {(k, 0): value for k, value in enumerate(omega)})
    turning = matrices.product(transposed(rate_map(builder, p)), half)
    excess = builder.emit(Op.SUBTRACT, builder.constant(1), norm_squared(builder, p))
    pull = builder.emit(Op.MULTIPLY, builder.constant(NORM_DAMPING), excess)
    return [builder.emit(Op.ADD, turning[k, 0], builder.emit(Op.MULTIPLY, pull, p[k])) for k in range(4)]


def _motion(state: State, found: dict[str, Entries], mass: Program) -> Entries:
    acceleration = {(k, 0): value for k, value in enumerate(state.acceleration)}
    inertia = state.matrices.product(state.evaluated(mass)["mass"], acceleration)
    return state.matrices.total((inertia, found["phi_q_t_lambda"], state.matrices.negative(found["force"])))


def _phi_t(state: State) -> Entries:
    first = len(state.system.assembly.rows)
    rates = ((first + k, driven.drive) for k, driven in enumerate(state.system.drives))
    return {(row, 0): _drive_rate(state.builder, drive) for row, drive in rates if drive.speed or drive.amplitude}


def _drive_rate(builder: Builder, drive: Drive) -> int:
    """``-speed - amplitude frequency cos(frequency t + phase)``."""
    emit, constant = builder.emit, builder.constant
    steady = constant(-drive.speed)
    if not drive.amplitude:
        return steady
    turned = emit(Op.MULTIPLY, constant(drive.frequency), builder.input("t", 0))
    cosine = emit(Op.COS, emit(Op.ADD, turned, constant(drive.phase)))
    return emit(Op.ADD, steady, emit(Op.MULTIPLY, constant(-drive.amplitude * drive.frequency), cosine))


def _accelerations(state: State, found: dict[str, Entries], drift: Entries, beta: Fraction) -> Entries:
    """``phi_q a - gamma + 2 beta (phi_q v + phi_t) + beta^2 phi``."""
    matrices, constant = state.matrices, state.builder.constant
    acceleration = {(k, 0): value for k, value in enumerate(state.acceleration)}
    return matrices.total(
        (
            matrices.product(found["phi_q"], acceleration),
            matrices.negative(found["gamma"]),
            matrices.scaled(constant(2 * beta), drift),
            matrices.scaled(constant(beta * beta), found["phi"]),
        )
    )
