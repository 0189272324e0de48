"""`Program`: a frozen list of scalar instructions in static single assignment, with its arguments and outputs.

Every stage after the symbolic model takes a program and gives one (``passes``), or reads it (``emit``, ``flopcount``,
:mod:`codegen.ir.evaluate`). An instruction refers to its operands by their position; operands always stand before it.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import accumulate
from typing import NamedTuple

from codegen.errors import InternalError
from codegen.ir.ops import ARITY, Constant, Op


@dataclass(frozen=True, slots=True)
class Argument:
    """A dense input array, column-major.

    Attributes:
        name: as in the C signature, for example ``A_i``.
        shape: rows and columns.
    """

    name: str
    shape: tuple[int, int]

    @property
    def length(self) -> int:
        """Number of scalars."""
        return self.shape[0] * self.shape[1]


@dataclass(frozen=True, slots=True)
class Sparsity:
    """Pattern of a matrix in compressed columns, as CasADi and SuiteSparse have it.

    Attributes:
        nrow: number of rows.
        ncol: number of columns.
        colind: [ncol + 1] offset of each column's first nonzero.
        row: [colind[-1]] row of each nonzero.
    """

    nrow: int
    ncol: int
    colind: tuple[int, ...]
    row: tuple[int, ...]

    @property
    def nonzeros(self) -> int:
        """Number of structural nonzeros."""
        return len(self.row)

    def entries(self) -> list[tuple[int, int]]:
        """Give (row, column) of each nonzero, in storage order."""
        columns = zip(self.colind, self.colind[1:], strict=False)
        return [(self.row[k], column) for column, (start, end) in enumerate(columns) for k in range(start, end)]

    @staticmethod
    def of_entries(nrow: int, ncol: int, entries: Iterable[tuple[int, int]]) -> Sparsity:
        """Build the pattern that holds the given (row, column) places."""
        ordered = sorted((column, row) for row, column in entries)
        counts = [0] * (ncol + 1)
        for column, _ in ordered:
            counts[column + 1] += 1
        return Sparsity(nrow, ncol, tuple(accumulate(counts)), tuple(row for _, row in ordered))


class Instruction(NamedTuple):
    """One scalar operation; a tuple, since passes make them by the million.

    Attributes:
        op: the operation.
        operands: positions of the operands in the program.
        constant: value of a ``CONSTANT``.
        source: argument name and index of an ``INPUT``.
        label: stage and index this value belongs to, for example ``("A_ij", 4)``: a name for readers, no meaning.
    """

    op: Op
    operands: tuple[int, ...] = ()
    constant: Constant | None = None
    source: tuple[str, int] | None = None
    label: tuple[str, int] | None = None

    def with_operands(self, operands: tuple[int, ...]) -> Instruction:
        """Give the same instruction on other operands."""
        return Instruction(self.op, operands, self.constant, self.source, self.label)


@dataclass(frozen=True, slots=True)
class Result:
    """A matrix of which the structural nonzeros are stored.

    Attributes:
        name: as in the C signature, for example ``phi_q``.
        sparsity: pattern of the nonzeros; full for vectors.
    """

    name: str
    sparsity: Sparsity


@dataclass(frozen=True, slots=True)
class Output(Result):
    """A result of a program.

    Attributes:
        values: positions of the instructions that give the nonzeros, in storage order.
    """

    values: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Program:
    """A scalar program in static single assignment.

    Attributes:
        arguments: the inputs, in the order of the signature.
        instructions: operands precede their uses.
        outputs: the results, in the order of the signature.
        legend: stage name -> its definition in the notation of the papers, for readers.
    """

    arguments: tuple[Argument, ...]
    instructions: tuple[Instruction, ...]
    outputs: tuple[Output, ...]
    legend: tuple[tuple[str, str], ...] = ()

    def __post_init__(self) -> None:
        for position, instruction in enumerate(self.instructions):
            if len(instruction.operands) != ARITY[instruction.op]:
                raise InternalError(f"instruction {position}: {instruction.op.value} with {instruction.operands}")
            for operand in instruction.operands:
                if not 0 <= operand < position:
                    raise InternalError(f"instruction {position} uses a value that is not computed before it")
        for output in self.outputs:
            if len(output.values) != output.sparsity.nonzeros:
                raise InternalError(f"output {output.name}: {len(output.values)} values for its pattern")

    def output(self, name: str) -> Output:
        """Give the output of that name.

        Raises:
            KeyError: there is none.
        """
        for output in self.outputs:
            if output.name == name:
                return output
        raise KeyError(name)

    def live(self) -> list[bool]:
        """Say for each instruction whether an output depends on it."""
        marks = [False] * len(self.instructions)
        for output in self.outputs:
            for value in output.values:
                marks[value] = True
        for position in range(len(self.instructions) - 1, -1, -1):
            if marks[position]:
                for operand in self.instructions[position].operands:
                    marks[operand] = True
        return marks

    def uses(self) -> list[int]:
        """Count for each instruction how often operations and outputs take its value."""
        counts = [0] * len(self.instructions)
        for instruction in self.instructions:
            for operand in instruction.operands:
                counts[operand] += 1
        for output in self.outputs:
            for value in output.values:
                counts[value] += 1
        return counts

    def used_arguments(self) -> tuple[Argument, ...]:
        """Give the arguments that an output depends on, in order."""
        live = self.live()
        names = {
            instruction.source[0]
            for instruction, alive in zip(self.instructions, live, strict=True)
            if alive and instruction.source is not None
        }
        return tuple(argument for argument in self.arguments if argument.name in names)
