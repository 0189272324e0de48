"""`Grid`: a small dense matrix of program values, and its products over structural nonzeros."""

from __future__ import annotations

from codegen.ir.builder import Builder
from codegen.ir.ops import Op

Grid = tuple[tuple[int, ...], ...]
"""Rows of positions in the program under construction."""

Pattern = tuple[tuple[int, ...], ...]
"""What is known of each entry: 0 a zero, 1 plus or minus one, 2 anything."""


def pattern_of(grid: Grid, builder: Builder) -> Pattern:
    """Classify the entries of a grid."""
    return tuple(tuple(_class_of(entry, builder) for entry in row) for row in grid)


def _class_of(entry: int, builder: Builder) -> int:
    value = builder.value_of(entry)
    if value is None:
        return 2
    if value.is_zero:
        return 0
    return 1 if value.equals(1) or value.equals(-1) else 2


def product_pattern(left: Pattern, right: Pattern) -> tuple[Pattern, int]:
    """Give the pattern of a product and what it costs in multiplications and additions."""
    cost = 0
    rows = []
    for row in left:
        entries = []
        for column in zip(*right, strict=True):
            classes = [a * b for a, b in zip(row, column, strict=True) if a and b]
            cost += sum(1 for c in classes if c == 4) + max(len(classes) - 1, 0)
            entries.append(1 if classes == [1] else 2 if classes else 0)
        rows.append(tuple(entries))
    return tuple(rows), cost


def zeros(nrow: int, ncol: int, builder: Builder) -> Grid:
    """A grid of zeros."""
    zero = builder.constant(0)
    return tuple((zero,) * ncol for _ in range(nrow))


def transpose(grid: Grid) -> Grid:
    """Rows for columns."""
    return tuple(zip(*grid, strict=True))


def skew(vector: Grid, builder: Builder) -> Grid:
    """Skew matrix of a [3, 1] grid."""
    x, y, z = (row[0] for row in vector)
    zero = builder.constant(0)
    minus = [_negate(entry, builder) for entry in (x, y, z)]
    return ((zero, minus[2], y), (z, zero, minus[0]), (minus[1], x, zero))


def _negate(entry: int, builder: Builder) -> int:
    value = builder.value_of(entry)
    return builder.constant(-value) if value is not None else builder.emit(Op.NEGATE, entry)


def base_of(entry: int, builder: Builder) -> int:
    """The value that an entry is plus or minus of."""
    instruction = builder.instructions[entry]
    return instruction.operands[0] if instruction.op is Op.NEGATE else entry


def multiply(left: Grid, right: Grid, builder: Builder) -> Grid:
    """Product of two grids over their structural nonzeros."""
    columns = transpose(right)
    return tuple(tuple(_inner(row, column, builder) for column in columns) for row in left)


def _inner(row: tuple[int, ...], column: tuple[int, ...], builder: Builder) -> int:
    products = [
        builder.emit(Op.MULTIPLY, a, b)
        for a, b in zip(row, column, strict=True)
        if _class_of(a, builder) and _class_of(b, builder)
    ]
    return total(products, builder)


def total(entries: list[int], builder: Builder) -> int:
    """Sum of values, from the left; the sum of none is zero."""
    if not entries:
        return builder.constant(0)
    result = entries[0]
    for entry in entries[1:]:
        result = builder.emit(Op.ADD, result, entry)
    return result


def scale(factor: int, grid: Grid, builder: Builder) -> Grid:
    """Multiply each structural nonzero by a scalar value."""
    return tuple(
        tuple(builder.emit(Op.MULTIPLY, factor, entry) if _class_of(entry, builder) else entry for entry in row)
        for row in grid
    )


def add(grids: list[Grid], builder: Builder) -> Grid:
    """Sum of grids of one shape, over structural nonzeros."""
    return tuple(
        tuple(
            total([entry for entry in places if _class_of(entry, builder)], builder)
            for places in zip(*rows, strict=True)
        )
        for rows in zip(*grids, strict=True)
    )
