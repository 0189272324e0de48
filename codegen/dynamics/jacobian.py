"""The Jacobian ``dF/dy + cj dF/dydot`` of the residual, in compressed columns.

By the chain rule from derivatives by displacements: ``delta pi = s G(p) delta p`` (`codegen.dynamics.attitude`). The
derivative of ``phi_q^T mu`` is left out, since mu vanishes on solutions; where mu is 0 the Jacobian is exact.
"""

from __future__ import annotations

from collections.abc import Collection
from fractions import Fraction

from codegen.dynamics.attitude import norm_squared, rate_map
from codegen.dynamics.condensation import completed, eliminated
from codegen.dynamics.layout import Layout
from codegen.dynamics.matrices import moved, transposed
from codegen.dynamics.residual import NORM_DAMPING, arguments
from codegen.ir.inline import Entries
from codegen.ir.ops import Op
from codegen.ir.program import Argument, Output, Program, Sparsity
from codegen.mechanics.system import System

INDEX2 = ("phi_q", "phi_q_t_lambda_q", "phi_q_v_q", "force_q", "force_v")
"""Quantities that the Jacobian takes; at index 1 also the derivatives of ``gamma``, where it is condensed ``force``."""

SECOND = ("phi_q_t_lambda_q", "phi_q_v_q", "force_q", "force_v")
"""Those that may be left out: Newton's iteration converges more slowly, to the same solution."""


def jacobian(
    system: System,
    layout: Layout,
    program: Program,
    mass: Program,
    *,
    left_out: Collection[str] = (),
    gamma: Program | None = None,
    beta: Fraction = Fraction(0),
) -> Program:
    """Compose the Jacobian; not simplified.

    Args:
        system: the mechanism.
        layout: of the state; it says which index.
        program: of `INDEX2`.
        mass: `codegen.mechanics.mass.mass`.
        left_out: terms of `SECOND` that are left out.
        gamma: ``gamma_q`` and ``gamma_v``, for index 1.
        beta: of Baumgarte's stabilisation, 1/s.

    Returns:
        A program of ``t``, ``y``, ``ydot``, ``cj`` and ``revolutions`` with the output ``jacobian``.
    """
    composed = _Jacobian(system, layout, program, mass, left_out)
    parts = [composed.positions(), composed.motion()]
    if gamma is None:
        parts += [composed.constraints(), composed.drift()]
    else:
        parts.append(composed.accelerations(program, gamma, beta))
    entries = eliminated(composed.state, composed.state.matrices.total(parts))
    sparsity = Sparsity.of_entries(layout.size, layout.size, entries)
    output = Output("jacobian", sparsity, tuple(entries[place] for place in sparsity.entries()))
    signature = arguments(system, layout, Argument("cj", (1, 1)))
    return composed.state.builder.freeze(signature, (output,))


class _Jacobian:
    """Blocks of the Jacobian, at their places."""

    def __init__(
        self, system: System, layout: Layout, program: Program, mass: Program, left_out: Collection[str]
    ) -> None:
        self.state = completed(system, layout, program)
        self._layout = self.state.layout
        self._matrices = self.state.matrices
        self._builder = self.state.builder
        self._left_out = left_out
        self._found = self._evaluated(program)
        self._mass = self.state.evaluated(mass)["mass"]
        self._cj = self._builder.input("cj", 0)

    def _evaluated(self, program: Program) -> dict[str, Entries]:
        found = self.state.evaluated(program)
        return {name: {} if name in self._left_out else entries for name, entries in found.items()}

    # --- rows

    def positions(self) -> Entries:
        """Rows of the positions."""
        state, matrices, layout = self.state, self._matrices, self._layout
        one = self._builder.constant(1)
        rates = {(k, k): self._cj for k in layout.positions}
        maps = self._rate_maps()
        negative = matrices.negative(maps)
        parts = [rates, moved(negative, 0, layout.velocities.start)]
        if layout.corrections:
            correction = matrices.product(transposed(state.axes_of_velocity), transposed(self._found["phi_q"]))
            parts.append(moved(matrices.product(negative, correction), 0, layout.corrections.start))
        if not state.is_planar:
            parts += [self._attitude_rates(body, one) for body in state.bodies]
        return matrices.total(parts)

    def _rate_maps(self) -> Entries:
        """What the rates of the positions are of the velocities: ``G^T / 2`` for Euler parameters."""
        state, builder = self.state, self._builder
        found: Entries = {}
        one, half = builder.constant(1), builder.constant(Fraction(1, 2))
        moves = state.arrays.displacements
        for body in state.bodies:
            row, column = state.stride * body, moves * body
            found |= {(row + k, column + k): one for k in range(state.axes)}
            if state.is_planar:
                found[row + 2, column + 2] = one
            else:
                turning = rate_map(builder, state.y(state.attitude_places(body)))
                found |= moved(self._matrices.scaled(half, transposed(turning)), row + 3, column + 3)
        first = moves * len(state.bodies)
        return found | {(place, first + k): one for k, place in enumerate(state.alpha_places)}

    def _attitude_rates(self, body: int, one: int) -> Entries:
        """Derivative of ``-G^T omega / 2 - NORM_DAMPING (1 - p . p) p`` by p."""
        state, builder, matrices = self.state, self._builder, self._matrices
        places = state.attitude_places(body)
        p = state.y(places)
        first = self._layout.velocities.start + state.arrays.displacements * body + 3
        x, y, z = matrices.scaled(
            builder.constant(Fraction(1, 2)), {(k, 0): y for k, y in enumerate(state.y(range(first, first + 3)))}
        ).values()
        across = {(0, k + 1): value for k, value in enumerate((x, y, z))}
        turning = across | matrices.negative(transposed(across)) | moved(matrices.skew((x, y, z)), 1, 1)
        excess = builder.emit(Op.SUBTRACT, one, norm_squared(builder, p))
        damping, twice = builder.constant(-NORM_DAMPING), builder.constant(2 * NORM_DAMPING)
        scaled = [builder.emit(Op.MULTIPLY, twice, entry) for entry in p]
        outer = {(i, k): builder.emit(Op.MULTIPLY, scaled[i], p[k]) for i in range(4) for k in range(4)}
        diagonal = {(k, k): builder.emit(Op.MULTIPLY, damping, excess) for k in range(4)}
        return moved(matrices.total((turning, outer, diagonal)), places.start, places.start)

    def motion(self) -> Entries:
        """Rows ``M a + phi_q^T lambda - force``."""
        state, matrices, layout = self.state, self._matrices, self._layout
        found = self._found
        by_velocity = matrices.negative(found["force_v"])
        turning = matrices.product(self._mass, state.turning(state.acceleration))
        turning_velocity = matrices.product(by_velocity, state.turning(state.velocity))
        force = matrices.negative(found["force_q"])
        stiffness = matrices.total((found["phi_q_t_lambda_q"], force, turning, turning_velocity))
        inertia = matrices.total((matrices.scaled(self._cj, self._mass), by_velocity))
        first = layout.velocities.start
        return matrices.total(
            (
                moved(matrices.product(stiffness, state.displacements), first, 0),
                moved(matrices.product(inertia, state.axes_of_velocity), first, first),
                moved(transposed(found["phi_q"]), first, layout.multipliers.start),
            )
        )

    def constraints(self) -> Entries:
        """Rows ``phi``."""
        by_position = self._matrices.product(self._found["phi_q"], self.state.displacements)
        return moved(by_position, self._layout.multipliers.start, 0)

    def drift(self) -> Entries:
        """Rows ``phi_q v + phi_t``."""
        by_position, by_velocity = self._drift()
        first = self._layout.corrections.start
        parts = (moved(by_position, first, 0), moved(by_velocity, first, self._layout.velocities.start))
        return self._matrices.total(parts)

    def _drift(self) -> tuple[Entries, Entries]:
        """Derivatives of ``phi_q v`` by the positions and by the velocities."""
        state, matrices, phi_q = self.state, self._matrices, self._found["phi_q"]
        turning = matrices.product(phi_q, state.turning(state.velocity))
        by_displacement = matrices.total((self._found["phi_q_v_q"], turning))
        by_position = matrices.product(by_displacement, state.displacements)
        return by_position, matrices.product(phi_q, state.axes_of_velocity)

    def accelerations(self, program: Program, gamma: Program, beta: Fraction) -> Entries:
        """Rows ``phi_q a - gamma + 2 beta (phi_q v + phi_t) + beta^2 phi``."""
        state, matrices, constant = self.state, self._matrices, self._builder.constant
        phi_q, changing = self._found["phi_q"], state.evaluated(gamma)
        at_acceleration = state.evaluated(program, velocity=state.acceleration)["phi_q_v_q"]
        by_velocity = matrices.negative(changing["gamma_v"])
        by_displacement = matrices.total(
            (
                at_acceleration,
                matrices.product(phi_q, state.turning(state.acceleration)),
                matrices.negative(changing["gamma_q"]),
                matrices.product(by_velocity, state.turning(state.velocity)),
                matrices.scaled(constant(beta * beta), phi_q),
            )
        )
        drift_q, drift_v = self._drift()
        twice = constant(2 * beta)
        by_position = matrices.product(by_displacement, state.displacements)
        rates = matrices.total((matrices.scaled(self._cj, phi_q), by_velocity))
        velocities = matrices.product(rates, state.axes_of_velocity)
        first, start = self._layout.multipliers.start, self._layout.velocities.start
        return matrices.total(
            (
                moved(matrices.total((by_position, matrices.scaled(twice, drift_q))), first, 0),
                moved(matrices.total((velocities, matrices.scaled(twice, drift_v))), first, start),
            )
        )
