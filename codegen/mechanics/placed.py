"""A joint of a scene: the library's formulation between bodies i and j, written for two bodies of the scene.

Symbols of the two bodies are shared by all joints; stages and joint frames belong to the joint. The geometry is
constant: a joint frame whose axes are axes of its body is no frame of its own, other constants are exact numbers.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from typing import Any

import sympy

from codegen.ir.lower import Block, Places
from codegen.mechanics import frames
from codegen.mechanics.arrays import BODY_SYMBOLS, Arrays, body_symbol, normal_symbol
from codegen.mechanics.derivation import is_matrix
from codegen.mechanics.formulation import Formulation
from codegen.mechanics.frames import A_i, A_ij, A_j, C_i, C_j, H, r_i, r_ij, r_j, s_i, s_j
from codegen.mechanics.links import Link, aligned_axes, contracted
from codegen.mechanics.normal_turns import about_normal
from codegen.mechanics.places import BODY_I, BODY_J, JOINT_I, JOINT_J, STAR, WORLD
from codegen.spec.markers import markers
from codegen.spec.scene import Joint, Marker, Matrix

ORIGIN = sympy.ImmutableDenseMatrix([0, 0, 0])
THIRD_AXIS = sympy.ImmutableDenseMatrix([0, 0, 1])


@dataclass(frozen=True)
class Ends:
    """Where a joint of a scene stands.

    Attributes:
        name: of the joint, an identifier.
        bodies: identifiers of body i and body j; ``world`` for the ground.
        numbers: of body i and body j; None for the ground.
        first_row: of the joint in the system.
        first_alpha: of its coordinates among those of all joints.
        alpha_column: of the first coordinate of all joints.
        arrays: layout of the bodies.
        dropped: rows of the system that are left out.
        varying: side and number of a coordinate of an attachment -> number in the argument ``geometry``.
        number: of the joint.
    """

    name: str
    bodies: tuple[str, str]
    numbers: tuple[int | None, int | None]
    first_row: int
    first_alpha: int
    alpha_column: int
    arrays: Arrays
    dropped: frozenset[int] = frozenset()
    varying: Mapping[tuple[int, int], int] = field(default_factory=dict)
    number: int = 0


@dataclass(frozen=True)
class Placed:
    """A joint's formulation in a scene.

    Attributes:
        joint: the joint of the scene.
        form: its formulation between bodies i and j.
        ends: where it stands.
        piece: which rows it has: ``whole``, or ``point`` or ``turn``, those that hold points together or those of the
            rotation.
    """

    joint: Joint
    form: Formulation
    ends: Ends
    piece: str = "whole"

    # --- symbols

    @cached_property
    def symbols(self) -> dict[Any, Any]:
        """What takes the place of each symbol of the formulation."""
        found: dict[Any, Any] = {}
        generic = ((r_i, A_i, frames.v_i, frames.omega_i), (r_j, A_j, frames.v_j, frames.omega_j))
        for symbols, body in zip(generic, self.ends.bodies, strict=True):
            found |= {old: body_symbol(word, body) for old, word in zip(symbols, BODY_SYMBOLS, strict=True)}
        count = self.form.coordinates
        own = [*self.form.stages, s_i, s_j, C_i, C_j, *([H] if H in self.form.stages else [])]
        found |= {symbol: _renamed(symbol, f"{symbol.name}_{self.ends.name}") for symbol in own}
        found[r_ij] = frames.vector("r_{}__{}".format(*self.ends.bodies))  # identifiers have single underscores
        found[A_ij] = frames.matrix(f"A_ij of {self.ends.name}")  # never written; no body "ij ..." has this name
        for series in (frames.alpha, frames.alpha_dot):
            last = series(self.ends.first_alpha + count)
            found |= dict(zip(series(count), last[self.ends.first_alpha :], strict=True))
        return found | self._multipliers | self._parameters

    @cached_property
    def _multipliers(self) -> dict[Any, Any]:
        """Those of rows that are left out are zero."""
        first, rows = self.ends.first_row, self.form.row_count
        multipliers = frames.multipliers(first + rows)[first:]
        kept = [sympy.S.Zero if first + k in self.ends.dropped else symbol for k, symbol in enumerate(multipliers)]
        return dict(zip(frames.multipliers(rows), kept, strict=True))

    @cached_property
    def _parameters(self) -> dict[Any, Any]:
        """The screw starts at angle 0; whole turns are counted where its angle is taken from the attitudes."""
        turns = sympy.S.Zero if self.form.coordinates else sympy.Symbol(f"revolutions_{self.ends.name}")
        return {frames.pitch: rational(self.joint.pitch), frames.theta_0: sympy.S.Zero, frames.revolutions: turns}

    @cached_property
    def markers(self) -> tuple[Marker, Marker]:
        """Joint frames as the form has them."""
        return markers(self.joint, "parametric" if self.form.coordinates else "conventional")

    @property
    def has_own_frames(self) -> bool:
        """Whether a joint frame has axes that are none of its body's."""
        return any(len(aligned_axes(_matrix(marker.axes))) < 3 for marker in self.markers)

    # --- frames

    @cached_property
    def frame_names(self) -> dict[str, str]:
        """Frame of the formulation -> frame of the scene."""
        body_i, body_j = self.ends.bodies
        own = {frame: f"{frame} {self.ends.name}" for frame in (JOINT_I, JOINT_J, STAR)}
        return {WORLD: WORLD, BODY_I: body_i, BODY_J: body_j} | own

    def places(self, generic: Places) -> Places:
        """Describe the frames of the joint in the scene.

        Args:
            generic: those of the formulation, see `codegen.mechanics.places.places`.
        """
        names, symbols = self.frame_names, self.symbols
        rotations = {symbols[old]: (names[a], names[b]) for old, (a, b) in generic.rotations.items()}
        given = [symbols[old] for old in self._attitudes_of(generic) if rotations[symbols[old]][1] != WORLD]
        same, explicit = self._constant_frames(generic, rotations)
        explicit |= {symbol: matrix for symbol, matrix in self._attitudes.items() if symbol in given}
        if self.ends.arrays.is_planar:
            same |= {(body, 2): (1, WORLD, 2) for body in self.ends.bodies if body != WORLD}
        frames_of = {symbols[old]: names[frame] for old, frame in generic.frames.items()}
        frames_of |= {normal_symbol(body): body for body in self.ends.bodies}
        return replace(
            generic,
            rotations=rotations,
            given=tuple(dict.fromkeys((*given, *explicit))),
            explicit=explicit,
            frames=frames_of,
            stages={symbols[old]: self.written(definition) for old, definition in generic.stages.items()},
            bodies={names[frame]: names[body] for frame, body in generic.bodies.items()},
            axes=frozenset(names[frame] for frame in generic.axes),
            columns=(),
            rows={self.ends.first_row + row: names[frame] for row, frame in generic.rows.items()},
            axis_names={
                names[frame]: tuple(f"{axis}_{self.ends.name}" for axis in axes)
                for frame, axes in generic.axis_names.items()
            },
            vector_names={symbols[old]: symbols[old].name for old in generic.vector_names},
            whole=frozenset(symbols[old] for old in generic.whole if old in symbols),
            constants=self._constants(frames_of),
            same_axes=same,
        )

    def _attitudes_of(self, generic: Places) -> list[Any]:
        """The attitudes among the given rotations.

        Where the joint relation takes the place of ``A_j`` and body j is the ground, ``A_i`` would lead there again, on
        another way than the joint.
        """
        if A_j not in generic.given and self.ends.numbers[1] is None:
            return []
        return [symbol for symbol in generic.given if symbol in (A_i, A_j)]

    def _constants(self, known: Mapping[Any, str]) -> dict[Any, Any]:
        """Attachments, what does not move, and what does not leave the plane."""
        found = {self.symbols[s]: self._attachment(side) for side, s in enumerate((s_i, s_j))}
        found |= {normal_symbol(body): THIRD_AXIS for body in self.ends.bodies}
        for body, number in zip(self.ends.bodies, self.ends.numbers, strict=True):
            still = {body_symbol(word, body): ORIGIN for word in BODY_SYMBOLS if word != "A"}
            found |= still if number is None else self.ends.arrays.components(body)
        found[self.symbols[r_ij]] = self._position(1) - self._position(0)
        return {symbol: value for symbol, value in found.items() if symbol in known}

    def _position(self, side: int) -> Any:
        """Components of the position of body i or body j; the ground stands still at the origin."""
        body, arrays = self.ends.bodies[side], self.ends.arrays
        if self.ends.numbers[side] is None:
            return ORIGIN
        r = body_symbol("r", body)
        return arrays.components(body).get(r, frames.column(r))

    def _attachment(self, side: int) -> Any:
        """Numbers, and symbols where they are read at run time."""
        varying = {k: geometry_symbol(number) for (of, k), number in self.ends.varying.items() if of == side}
        point = self.markers[side].point
        return sympy.ImmutableDenseMatrix([varying.get(k, rational(x)) for k, x in enumerate(point)])

    @cached_property
    def _attitudes(self) -> dict[Any, Any]:
        """Attitudes that are written out."""
        moving = [body for body, number in zip(self.ends.bodies, self.ends.numbers, strict=True) if number is not None]
        found = {body_symbol("A", body): self.ends.arrays.attitude_matrix(body) for body in moving}
        return {symbol: matrix for symbol, matrix in found.items() if matrix is not None}

    def _constant_frames(
        self, generic: Places, rotations: dict[Any, tuple[str, str]]
    ) -> tuple[dict[tuple[str, int], tuple[int, str, int]], dict[Any, Any]]:
        """Axes of the joint frames that are axes of others, and the matrices between the frames that are left.

        New rotations, such as ``C_i H`` where the joint frame on body i is none of its own, are added to those given.
        """
        same: dict[tuple[str, int], tuple[int, str, int]] = {}
        links: list[Link] = []
        for C, marker in zip((C_i, C_j), self.markers, strict=True):
            body, frame = rotations[self.symbols[C]]
            if all((frame, k) not in same for k in range(3)):  # else it is the frame of the other body
                aligned = aligned_axes(_matrix(marker.axes))
                same |= {(frame, k): (sign, body, axis) for k, (sign, axis) in aligned.items()}
            links.append(Link(self.symbols[C].name, body, frame, _matrix(marker.axes)))
        if H in generic.explicit:
            start, end = rotations[self.symbols[H]]
            links.append(Link(self.symbols[H].name, start, end, self.written(generic.explicit[H])))
        explicit = {}
        passed = {frame for frame, _ in same if all((frame, k) in same for k in range(3))}
        for link in contracted(links, passed, f"R_{self.ends.name}"):
            link = link.reversed if link.end == self.ends.bodies[0] else link
            symbol = frames.matrix(link.name)
            rotations[symbol] = (link.start, link.end)
            explicit[symbol] = link.matrix
            same |= {(link.end, k): (sign, link.start, axis) for k, (sign, axis) in aligned_axes(link.matrix).items()}
        return same, explicit

    # --- blocks

    def columns(self) -> dict[int, int | None]:
        """First column of each displacement of the formulation -> column in the system; None for the ground."""
        found: dict[int, int | None] = {}
        for k, number in enumerate(self.ends.numbers):
            for part in (0, 3):
                found[6 * k + part] = None if number is None else self.ends.arrays.derived * number + part
        first = self.ends.alpha_column + self.ends.first_alpha
        return found | {12 + k: first + k for k in range(self.form.coordinates)}

    def column_frames(self, translations: str) -> dict[int, str]:
        """First column of each displacement of the bodies -> its frame.

        Args:
            translations: axes of the virtual translations, ``world`` or ``body``.
        """
        found = {}
        for body, number in zip(self.ends.bodies, self.ends.numbers, strict=True):
            if number is not None:
                first = self.ends.arrays.derived * number
                found[first] = body if translations == "body" else WORLD
                found[first + 3] = body
        return found

    def blocks(self, row_kind: str, column_kind: str, blocks: tuple[Block, ...]) -> Iterator[Block]:
        """Write the blocks of a quantity for the scene.

        Args:
            row_kind: what its rows are, ``constraints``, ``joints`` or ``displacements``.
            column_kind: what its columns are, ``displacements`` or ``one``.
            blocks: of the quantity between bodies i and j.
        """
        columns = self.columns()
        for block in blocks:
            is_displaced = row_kind == "displacements", column_kind == "displacements"
            row = self._row(row_kind, block.row)
            column = columns[block.column] if is_displaced[1] else block.column
            if row is None or column is None or (row_kind == "constraints" and self._is_dropped(row, block.expression)):
                continue
            expression = self.written(block.expression)
            if self.ends.arrays.is_planar:
                rows = self._normals.get(block.row) if is_displaced[0] else None
                expression = about_normal(
                    expression, rows, self._normals.get(block.column) if is_displaced[1] else None
                )
            yield Block(row, column, expression)

    def _row(self, kind: str, row: int) -> int | None:
        """The row of the system for a row of a quantity; None for the ground."""
        if kind == "joints":
            return self.ends.number
        return self.columns()[row] if kind == "displacements" else row + self.ends.first_row

    @cached_property
    def _normals(self) -> dict[int, Any]:
        """Turns of the formulation -> the normal, an axis of the body that turns."""
        body_i, body_j = self.ends.bodies
        return {3: normal_symbol(body_i), 9: normal_symbol(body_j)}

    def _is_dropped(self, row: int, expression: Any) -> bool:
        height = expression.shape[0] if is_matrix(expression) else 1
        return all(row + k in self.ends.dropped for k in range(height))

    def written(self, expression: Any) -> Any:
        """An expression of the formulation in the symbols of the scene."""
        return expression.xreplace(self.symbols)


def geometry_symbol(number: int) -> Any:
    """An entry of the argument ``geometry``, m."""
    return sympy.Symbol(f"geometry_{number}")


def rational(value: Fraction) -> Any:
    """An exact number."""
    return sympy.Rational(value.numerator, value.denominator)


def _matrix(matrix: Matrix) -> Any:
    return sympy.ImmutableDenseMatrix([[rational(x) for x in row] for row in matrix])


def _renamed(symbol: Any, name: str) -> Any:
    return sympy.MatrixSymbol(name, *symbol.shape) if is_matrix(symbol) else sympy.Symbol(name)
