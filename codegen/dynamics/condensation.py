"""Equations without what constants tie to the rest: rates of joint coordinates, their multipliers and corrections.

With ``P`` of `codegen.mechanics.condensed`, ``c`` its rows and ``a`` its coordinates,

- ``P w_a = -(phi_q v)_c`` without these rates, from the rows ``phi_q v = 0``;
- ``P^T lambda_c = force_a - (phi_q^T lambda)_a`` without these multipliers, from the rows of motion, since joint
  coordinates have no mass;
- ``P^T mu_c = -(phi_q^T mu)_a`` likewise: positions are corrected without the joint coordinates.

Each takes a row and an unknown away. The coordinates stay, determined by ``phi_c = 0`` alone: these rows stand where
their rates had theirs.
"""

from __future__ import annotations

from collections.abc import Iterable

from codegen.dynamics.layout import Layout
from codegen.dynamics.matrices import transposed
from codegen.dynamics.state import State
from codegen.ir.inline import Entries
from codegen.ir.ops import Op
from codegen.ir.program import Program
from codegen.mechanics.system import System


def completed(system: System, layout: Layout, program: Program) -> State:
    """A state that knows the entries it leaves out.

    Args:
        system: the mechanism.
        layout: of the state.
        program: of ``phi_q``, or of ``phi_q_v`` and ``phi_q_t_lambda``; of ``force``.
    """
    state = State(system, layout)
    if layout.condensed.coordinates:
        state.inverse = _inverse(state, program)
        velocity = state.in_program_axes(state.y(state.layout.velocities))
        _know(state, _rate_places(state), _solved(state, _drift(state, program, velocity), is_transposed=False))
        acting = state.evaluated(program)["force"]
        for places, force in ((state.layout.multipliers, acting), (state.layout.corrections, {})):
            held = state.matrices.total((_held(state, program, places), state.matrices.negative(force)))
            along = {(k, 0): held[n, 0] for k, n in enumerate(_displacements(state)) if (n, 0) in held}
            _know(state, _row_places(state, places), _solved(state, along, is_transposed=True))
    return state


def _drift(state: State, program: Program, velocity: list[int]) -> Entries:
    """``phi_q v`` in the rows."""
    found = state.evaluated(program, velocity=velocity)
    drift = found.get("phi_q_v") or state.matrices.product(found["phi_q"], _column(velocity))
    rows = state.given.condensed.rows
    return {(k, 0): drift[row, 0] for k, row in enumerate(rows) if (row, 0) in drift}


def _held(state: State, program: Program, places: range) -> Entries:
    """``phi_q^T lambda``, or mu in the place of lambda."""
    multipliers = state.y(places)
    found = state.evaluated(program, multipliers=multipliers)
    return found.get("phi_q_t_lambda") or state.matrices.product(transposed(found["phi_q"]), _column(multipliers))


def _column(values: Iterable[int]) -> Entries:
    return {(k, 0): value for k, value in enumerate(values)}


def _solved(state: State, right: Entries, is_transposed: bool) -> Entries:
    """``-P^-1 right`` or ``-P^-T right``; what is missing is zero."""
    inverse = state.matrices.negative(state.inverse)
    return state.matrices.product(transposed(inverse) if is_transposed else inverse, right)


def _inverse(state: State, program: Program) -> Entries:
    """``P^-1``: constants, or from the pose joint by joint, with the pivots that are right where joints are closed."""
    condensed = state.given.condensed
    if condensed.is_constant:
        return {(a, b): state.builder.constant(value) for a, b, value in condensed.inverse}
    columns = _condensing(state, program)
    found: Entries = {}
    for placed in state.system.assembly.placed:
        first = placed.ends.first_alpha
        own = range(first, first + placed.form.coordinates)
        found |= _inverted(
            state, columns, [k for k, coordinate in enumerate(condensed.coordinates) if coordinate in own]
        )
    return found


def _condensing(state: State, program: Program) -> Entries:
    """``P``, the columns of ``phi_q`` by the coordinates in their rows: what unit velocities are there."""
    rows = state.given.condensed.rows
    entries: Entries = {}
    for column, place in enumerate(_displacements(state)):
        unit = [state.builder.constant(int(k == place)) for k in range(state.size)]
        found = state.evaluated(program, velocity=unit)
        rates = found.get("phi_q_v") or state.matrices.product(found["phi_q"], _column(unit))
        entries |= {(k, column): rates[row, 0] for k, row in enumerate(rows) if (row, 0) in rates}
    return entries


def _inverted(state: State, block: Entries, group: list[int]) -> Entries:
    """The inverse of the block of some rows and columns, by Gauss and Jordan with its diagonal as pivots."""
    emit, one = state.builder.emit, state.builder.constant(1)
    left = {(i, k): block[i, k] for i in group for k in group if (i, k) in block}
    right: Entries = {(k, k): one for k in group}
    for k in group:
        pivot = left[k, k]
        for matrix in (left, right):
            for i, column in [place for place in matrix if place[0] == k]:
                matrix[i, column] = emit(Op.DIVIDE, matrix[i, column], pivot)
        for i in (i for i in group if i != k and (i, k) in left):
            factor = left[i, k]
            for matrix in (left, right):
                scaled = {(i, c): emit(Op.MULTIPLY, factor, value) for (r, c), value in matrix.items() if r == k}
                matrix |= state.matrices.total((matrix, state.matrices.negative(scaled)))
    return right


def _know(state: State, places: list[int], values: Entries) -> None:
    for (k, _), value in values.items():
        state.know(places[k], value)


# --- places among all entries


def _displacements(state: State) -> list[int]:
    first = state.arrays.displacements * len(state.bodies)
    return [first + k for k in state.given.condensed.coordinates]


def _rate_places(state: State) -> list[int]:
    return [state.layout.velocities[k] for k in _displacements(state)]


def _row_places(state: State, places: range) -> list[int]:
    return [places[k] for k in state.given.condensed.rows]


def _rows(state: State) -> dict[int, int]:
    """Row among all -> row; those of the constraints that determine the coordinates stand in the place of the rates."""
    found = {place: k for k, place in enumerate(state.given.places)}
    condensed = state.given.condensed
    for coordinate, row in zip(condensed.coordinates, condensed.rows, strict=True):
        found[state.layout.multipliers[row]] = found.pop(state.layout.coordinates[coordinate])
    return found


# --- rows and columns


def without_condensed(state: State, rows: Entries) -> Entries:
    """The rows of a residual that are left, at their places."""
    kept = _rows(state)
    return {(kept[row], column): value for (row, column), value in rows.items() if row in kept}


def eliminated(state: State, jacobian: Entries) -> Entries:
    """The Jacobian of the rows that are left by the unknowns that are left, by the chain rule."""
    if not state.given.condensed.coordinates:
        return jacobian
    layout = state.layout
    positions = [layout.coordinates[k] for k in state.given.condensed.coordinates]
    mu = {place: value for place, value in jacobian.items() if place[0] in positions and place[1] in layout.corrections}
    jacobian = {place: value for place, value in jacobian.items() if place[0] not in positions}
    jacobian |= state.matrices.negative(mu)
    rates, multipliers = _rate_places(state), _row_places(state, layout.multipliers)
    corrections = _row_places(state, layout.corrections)
    jacobian = _substituted(state, jacobian, corrections, rates, is_transposed=False)
    jacobian = _substituted(state, jacobian, rates, multipliers, is_transposed=True)
    jacobian = _substituted(state, jacobian, positions, corrections, is_transposed=True)
    kept, columns = _rows(state), {place: k for k, place in enumerate(state.given.places)}
    return {
        (kept[row], columns[column]): value
        for (row, column), value in jacobian.items()
        if row in kept and column in columns
    }


def _substituted(state: State, jacobian: Entries, rows: list[int], unknowns: list[int], is_transposed: bool) -> Entries:
    """Solve rows for unknowns, whose constants in them are ``P`` or ``P^T``, and put these into the others."""
    number, place = {row: k for k, row in enumerate(rows)}, {column: k for k, column in enumerate(unknowns)}
    right = {
        (number[row], column): value
        for (row, column), value in jacobian.items()
        if row in number and column not in place
    }
    solution = _solved(state, right, is_transposed)
    left = {(row, column): value for (row, column), value in jacobian.items() if row not in number}
    factors = {(row, place[column]): value for (row, column), value in left.items() if column in place}
    rest = {key: value for key, value in left.items() if key[1] not in place}
    return state.matrices.total((rest, state.matrices.product(factors, solution)))
