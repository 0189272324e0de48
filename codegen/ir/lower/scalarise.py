"""Write a choice of alternatives as scalar operations."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from codegen.errors import InternalError
from codegen.ir.builder import Builder
from codegen.ir.lower.alternatives import Alternative
from codegen.ir.lower.graph import Choice, Graph
from codegen.ir.lower.polynomial import Coefficient
from codegen.ir.lower.scalar_forms import Sum
from codegen.ir.ops import Op

Entries = tuple[int, ...]
"""Positions of a node's entries in the program; of a block row by row."""

Inputs = Callable[[str], int]
"""Appends a scalar input or constant symbol by its name."""

Signs = Sequence[tuple[int, bool]]
"""For each of several matrices its sign and whether it is transposed."""

_FUNCTIONS = {"sin": Op.SIN, "cos": Op.COS, "atan2": Op.ATAN2, "sqrt": Op.SQRT}


class Scalariser:
    """Computes nodes in a program under construction, each once.

    Args:
        graph: alternatives of every node.
        choice: of an alternative for every node that is needed.
        builder: where operations go.
        inputs: how a scalar symbol is read.
        finished: told node and entries when a node is done, to name it for readers.
    """

    def __init__(
        self,
        graph: Graph,
        choice: Choice,
        builder: Builder,
        inputs: Inputs,
        finished: Callable[[int, Entries], None],
    ) -> None:
        self._graph = graph
        self._choice = choice
        self._builder = builder
        self._inputs = inputs
        self._finished = finished
        self._entries: dict[int, Entries] = {}

    def entries(self, node: int) -> Entries:
        """Positions of the entries of a node; computes it when it is first asked for."""
        if node not in self._entries:
            alternative = self._graph[node][self._choice[node]]
            children = [self.entries(child) for child in alternative.children]
            self._entries[node] = self._formula(alternative, children)
            self._finished(node, self._entries[node])
        return self._entries[node]

    def signed(self, sign: int, position: int) -> int:
        """Plus or minus a value."""
        constant = self._builder.value_of(position)
        if sign > 0:
            return position
        return self._builder.constant(-constant) if constant is not None else self._builder.emit(Op.NEGATE, position)

    # --- formulas

    def _formula(self, alternative: Alternative, children: list[Entries]) -> Entries:
        data = alternative.data
        match alternative.kind:
            case "given":
                return self._given(children, data)
            case "same":
                return tuple(self.signed(data, entry) for entry in children[0])
            case "components":
                return tuple(self.signed(s, child[0]) for s, child in zip(data, children, strict=True))
            case "turned":
                return self._turned(children[0], children[1:], *data)
            case "sum":
                return self._weighted(children, data)
            case "cross":
                left = [self.signed(data, entry) for entry in children[0]]
                return self._cross(left, children[1])
            case "constant":
                return (self._builder.constant(data),)
            case "input":
                return (self._inputs(data),)
            case "function":
                return (
                    self._function(data[0], [self.signed(s, c[0]) for s, c in zip(data[1], children, strict=True)]),
                )
            case "dot":
                return (self.signed(data, self._inner(children[0], children[1])),)
            case "trace":
                return (self.signed(data, self._total([children[0][k] for k in (0, 4, 8)])),)
            case "total":
                return (self._total([self.signed(s, c[0]) for s, c in zip(data, children, strict=True)]),)
            case "product":
                return (self.signed(data, self._times(children[0][0], children[1][0])),)
            case "polynomial":
                plan, atoms = data
                return (self._plan(plan, dict(zip(atoms, (child[0] for child in children), strict=True))),)
        return self._block(alternative.kind, children, data)

    def _block(self, kind: str, children: list[Entries], data: Any) -> Entries:
        match kind:
            case "outer":
                return tuple(self._times(self.signed(data, a), b) for a in children[0] for b in children[1])
            case "rotation":
                by, sign = data
                factor = self.signed(sign, children[0][0])
                return self._placed([[self._times(factor, entry) for entry in axis] for axis in children[1:]], by)
            case "skewed":
                by, sign = data
                vector = [self.signed(sign, entry) for entry in children[0]]
                pairs = [(vector, axis) if by == "columns" else (axis, vector) for axis in children[1:]]
                return self._placed([self._cross(left, right) for left, right in pairs], by)
            case "joined":
                return self._joined(children, data)
            case "assembled":
                return self._assembled(children, *data)
            case "deviator":
                return self._deviator(children, *data)
            case "turned block":
                return self._turned_block(children[0], children[1:], *data)
        raise InternalError(f"no formula {kind}")

    def _turned(self, vector: Entries, axes: Sequence[Entries], by: str, sign: int) -> Entries:
        rows = list(zip(*axes, strict=True)) if by == "columns" else list(axes)
        return tuple(self._inner(row, [self.signed(sign, entry) for entry in vector]) for row in rows)

    def _weighted(self, children: list[Entries], signs: Sequence[tuple[int, int]]) -> Entries:
        factors, vectors = children[::2], children[1::2]
        terms: list[list[int]] = [[] for _ in vectors[0]]
        for (factor,), vector, (sign, is_unit) in zip(factors, vectors, signs, strict=True):
            for k, entry in enumerate(vector):
                terms[k].append(self.signed(sign * self._unit_sign(factor) if is_unit else sign, entry))
                if not is_unit:
                    terms[k][-1] = self.signed(sign, self._times(factor, entry))
        return tuple(self._total(entry) for entry in terms)

    def _unit_sign(self, factor: int) -> int:
        value = self._builder.value_of(factor)
        return -1 if value is not None and value.rational < 0 else 1

    def _cross(self, a: Sequence[int], b: Sequence[int]) -> Entries:
        places = [((k + 1) % 3, (k + 2) % 3) for k in range(3)]
        return tuple(
            self._total([self._times(a[p], b[q]), self.signed(-1, self._times(a[q], b[p]))]) for p, q in places
        )

    def _placed(self, axes: list[Sequence[int]] | list[list[int]] | list[Entries], by: str) -> Entries:
        """Entries row by row of a matrix given by its columns or rows."""
        rows = axes if by == "rows" else list(zip(*axes, strict=True))
        return tuple(entry for row in rows for entry in row)

    def _joined(self, blocks: list[Entries], signs: Signs) -> Entries:
        return tuple(self._total(entry) for entry in self._matrices(blocks, signs))

    def _assembled(self, children: list[Entries], signs: Signs, kappa_sign: int, tilde_sign: int) -> Entries:
        entries = self._matrices(children[: len(signs)], signs)
        rest = children[len(signs) :]
        if kappa_sign:
            kappa = self.signed(kappa_sign, rest[0][0])
            for k in (0, 4, 8):
                entries[k].append(kappa)
            rest = rest[1:]
        self._add_skew(entries, rest, tilde_sign)
        return tuple(self._total(entry) for entry in entries)

    def _deviator(self, children: list[Entries], signs: Signs, tilde_sign: int) -> Entries:
        """``M - (tr M) I``: the diagonal is minus the sums of the other two."""
        entries = self._matrices(children[: len(signs)], signs)
        diagonal = [self._total(entries[k]) for k in (0, 4, 8)]
        for k, (p, q) in zip((0, 4, 8), ((1, 2), (0, 2), (0, 1)), strict=True):
            entries[k] = [self.signed(-1, self._total([diagonal[p], diagonal[q]]))]
        self._add_skew(entries, children[len(signs) :], tilde_sign)
        return tuple(self._total(entry) for entry in entries)

    def _turned_block(
        self, block: Entries, axes: Sequence[Entries], sign: tuple[int, bool], by: str, side: str
    ) -> Entries:
        """``R M`` or ``M R`` with R by its columns or by its rows."""
        entries = [entry for (entry,) in self._matrices([block], [sign])]
        rotation = self._placed(list(axes), by)
        left, right = (rotation, entries) if side == "left" else (entries, rotation)
        return tuple(self._inner(left[3 * k : 3 * k + 3], right[n::3]) for k in range(3) for n in range(3))

    def _matrices(self, blocks: Sequence[Entries], signs: Signs) -> list[list[int]]:
        """For each entry the terms of a sum of matrices, some of them transposed."""
        terms: list[list[int]] = [[] for _ in range(9)]
        for (sign, is_turned), block in zip(signs, blocks, strict=True):
            for k in range(9):
                terms[k].append(self.signed(sign, block[3 * (k % 3) + k // 3 if is_turned else k]))
        return terms

    def _add_skew(self, entries: list[list[int]], vectors: Sequence[Entries], sign: int) -> None:
        for vector in vectors:
            for k, (p, q) in enumerate(((1, 2), (2, 0), (0, 1))):
                entries[3 * q + p].append(self.signed(sign, vector[k]))
                entries[3 * p + q].append(self.signed(-sign, vector[k]))

    # --- scalars

    def _given(self, scalars: list[Entries], components: Sequence[tuple[str, int] | int]) -> Entries:
        remaining = iter(scalars)
        return tuple(
            self._builder.input(*component)
            if isinstance(component, tuple)
            else self.signed(component, next(remaining)[0])
            for component in components
        )

    def _function(self, name: str, arguments: list[int]) -> int:
        if name == "ratio":
            return self._builder.emit(Op.DIVIDE, *arguments)
        return arguments[0] if name == "same" else self._builder.emit(_FUNCTIONS[name], *arguments)

    def _plan(self, plan: Sum, atoms: dict[int, int]) -> int:
        return self._total([self._product(term.coefficient, term.factors, atoms) for term in plan.terms])

    def _product(self, coefficient: Coefficient, factors: Sequence[int | Sum], atoms: dict[int, int]) -> int:
        values = [self._plan(f, atoms) if isinstance(f, Sum) else atoms[f] for f in factors]
        sign = 1 if coefficient > 0 else -1
        if abs(coefficient) != 1 or not values:
            values.insert(0, self._builder.constant(coefficient if coefficient > 0 else -coefficient))
        result = values[0]
        for value in values[1:]:
            result = self._times(result, value)
        return self.signed(sign, result)

    def _inner(self, left: Sequence[int], right: Sequence[int]) -> int:
        return self._total([self._times(a, b) for a, b in zip(left, right, strict=True)])

    def _times(self, a: int, b: int) -> int:
        return self._builder.emit(Op.MULTIPLY, a, b)

    def _total(self, values: Sequence[int]) -> int:
        kept = [value for value in values if not self._is_zero(value)]
        if not kept:
            return self._builder.constant(0)
        result, *others = self._differences_first(kept)
        for value in others:
            result = self._builder.emit(Op.ADD, result, value)
        return result

    def _differences_first(self, values: list[int]) -> list[int]:
        """Begin with the difference of two inputs: far from the origin ``r_j - r_i`` is exact, ``r_j + s_j`` is not."""
        plus = next((value for value in values if self._op(value) is Op.INPUT), None)
        minus = next((value for value in values if self._is_negated_input(value)), None)
        if plus is None or minus is None:
            return values
        return [plus, minus, *(value for value in values if value not in (plus, minus))]

    def _op(self, position: int) -> Op:
        return self._builder.instructions[position].op

    def _is_negated_input(self, position: int) -> bool:
        instruction = self._builder.instructions[position]
        return instruction.op is Op.NEGATE and self._op(instruction.operands[0]) is Op.INPUT

    def _is_zero(self, position: int) -> bool:
        value = self._builder.value_of(position)
        return value is not None and value.is_zero
