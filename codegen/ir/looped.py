"""`Looped`: programs that are run for one instance after another, each on its part of the arrays of the whole.

An instance has some rows of each array: one or a few runs of them, its segments. From one instance of a loop to the
next every segment moves on by the same number of entries, and so do the nonzeros in compressed columns, because the
columns of an instance have no nonzeros of another.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from itertools import accumulate

from codegen.errors import InternalError
from codegen.ir.ops import Constant
from codegen.ir.program import Argument, Program, Result, Sparsity

GEOMETRY = "geometry"
"""The argument of an instance that is read from the table of its loop."""


@dataclass(frozen=True, slots=True)
class Segment:
    """Entries of an axis that follow each other.

    Attributes:
        length: their number.
        start: place of the first entry in the whole, for the first instance.
        stride: entries from one instance to the next; 0 where all instances, even if there is but one, share them.
    """

    length: int
    start: int
    stride: int

    def place(self, instance: int) -> int:
        """Place of the first entry of an instance in the whole."""
        return self.start + self.stride * instance


Axis = tuple[Segment, ...]
"""The entries of an axis of an instance, in order; in the whole they are in the same order."""

SHARED: Axis = (Segment(1, 0, 0),)
"""An axis of one entry that all instances have: the time, the column of a vector."""


def places(axis: Axis, instance: int) -> list[int]:
    """Place in the whole of each entry of an axis."""
    return [segment.place(instance) + k for segment in axis for k in range(segment.length)]


@dataclass(frozen=True, slots=True)
class Block:
    """Nonzeros of an output of an instance that follow each other in storage.

    Attributes:
        entries: their numbers among the nonzeros of the program's output.
        start: place of the first among the nonzeros of the whole, for the first instance.
        stride: nonzeros from one instance to the next.
    """

    entries: range
    start: int
    stride: int


@dataclass(frozen=True, slots=True)
class Loop:
    """A program that is run for every instance.

    Attributes:
        program: of one instance.
        kind: number of the kind of instances, the same in all routines of a scene.
        count: number of instances.
        arguments: argument of the program -> its axis; ``geometry`` is not among them.
        outputs: output of the program -> axes of its rows and columns.
        geometry: the values of ``geometry``, instance by instance.
    """

    program: Program
    kind: int
    count: int
    arguments: Mapping[str, Axis]
    outputs: Mapping[str, tuple[Axis, Axis]]
    geometry: tuple[tuple[Constant, ...], ...]


@dataclass(frozen=True)
class Looped:
    """Loops one after the other; together they give every nonzero of the outputs once.

    Attributes:
        arguments: the arrays of the whole, in the order of the signature.
        shapes: output -> rows and columns.
        loops: of the kinds of instances, and of what is there only once.
        legend: as in `Program`.
    """

    arguments: tuple[Argument, ...]
    shapes: Mapping[str, tuple[int, int]]
    loops: tuple[Loop, ...]
    legend: tuple[tuple[str, str], ...] = field(default=())

    @cached_property
    def outputs(self) -> tuple[Result, ...]:
        """The results, in the order of the signature."""
        return tuple(Result(name, self._sparsity(name)) for name in self.shapes)

    def output(self, name: str) -> Result:
        """Give the output of that name.

        Raises:
            KeyError: there is none.
        """
        return {output.name: output for output in self.outputs}[name]

    def used_arguments(self) -> tuple[Argument, ...]:
        """Give the arguments that an output depends on, in order."""
        used = {argument.name for loop in self.loops for argument in loop.program.used_arguments()}
        return tuple(argument for argument in self.arguments if argument.name in used)

    @property
    def is_straight(self) -> bool:
        """Whether every instance is run once."""
        return all(loop.count == 1 for loop in self.loops)

    def _sparsity(self, name: str) -> Sparsity:
        nrow, ncol = self.shapes[name]
        columns: list[list[int]] = [[] for _ in range(ncol)]
        for loop in self.loops:
            entries = loop.program.output(name).sparsity.entries()
            for instance in range(loop.count):
                rows, own = (places(axis, instance) for axis in loop.outputs[name])
                for row, column in entries:
                    columns[own[column]].append(rows[row])
        ends = tuple(accumulate((len(column) for column in columns), initial=0))
        return Sparsity(nrow, ncol, ends, tuple(row for column in columns for row in sorted(column)))

    def blocks(self, loop: Loop, name: str) -> tuple[Block, ...]:
        """Where the nonzeros of an output of a loop are stored.

        Raises:
            InternalError: the nonzeros of an instance do not lie together.
        """
        own, whole = loop.program.output(name).sparsity, self.output(name).sparsity
        rows, columns = loop.outputs[name]
        found, column = list[Block](), 0
        for segment in columns:
            entries = range(own.colind[column], own.colind[column + segment.length])
            column += segment.length
            if segment.stride:
                begin, following = (whole.colind[segment.place(min(k, loop.count - 1))] for k in range(2))
                found.append(Block(entries, begin, following - begin))
            elif segment.length == 1:
                found += self._by_rows(rows, entries, own, segment.start, whole, loop.count)
            else:
                raise InternalError(f"several columns of {name} are shared by all instances")
        return tuple(block for block in found if block.entries)

    def _by_rows(
        self, rows: Axis, entries: range, own: Sparsity, column: int, whole: Sparsity, count: int
    ) -> Iterator[Block]:
        """The nonzeros in a column that all instances share, by the segments of the rows."""
        limits = whole.colind[column], whole.colind[column + 1]
        first = 0
        for segment in rows:
            inside = [k for k in entries if first <= own.row[k] < first + segment.length]
            if inside:
                row = own.row[inside[0]] - first
                found = [bisect_left(whole.row, segment.place(k) + row, *limits) for k in range(min(count, 2))]
                yield Block(range(inside[0], inside[-1] + 1), found[0], found[-1] - found[0])
            first += segment.length
