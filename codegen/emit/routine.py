"""`Routine`: one emitted function, with everything a caller must know of it.

The same data feed the C comment, the CasADi function and the manifest. What it is a routine of, a joint in one variant
or a scene, is its `Subject`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

from codegen.errors import InternalError
from codegen.ir.looped import Looped
from codegen.ir.program import Argument, Program, Result
from flopcount.counts import Counts

Member = tuple[str, int, tuple[int, int], str]
"""A part of a compound array: name, offset, shape, meaning."""


@dataclass(frozen=True, slots=True)
class Preparation:
    """What is computed once from the geometry, and how the result is laid out.

    Attributes:
        symbol: of the C function that computes it.
        counts: operations of that function.
        members: parts of the array ``prepared``.
    """

    symbol: str
    counts: Counts
    members: tuple[Member, ...]


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter of the C function.

    Attributes:
        name: as in the signature.
        direction: ``in`` or ``out``.
        shape: rows and columns of the matrix it holds.
        length: scalars in the array.
        layout: ``column-major``, or ``compressed-columns`` for nonzeros only.
        frame: axes of its components.
        unit: unit of its components.
        members: parts of a compound array.
        repeats: offset of a part that comes more than once -> how often, and entries from one to the next.
    """

    name: str
    direction: str
    shape: tuple[int, int]
    length: int
    layout: str
    frame: str
    unit: str
    members: tuple[Member, ...] = ()
    repeats: Mapping[int, tuple[int, int]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Words:
    """What is said of an argument or output.

    Attributes:
        frame: axes of its components.
        unit: unit of its components.
        members: parts of a compound array.
        repeats: offset of a part that comes more than once -> how often, and entries from one to the next.
    """

    frame: str
    unit: str
    members: tuple[Member, ...] = ()
    repeats: Mapping[int, tuple[int, int]] = field(default_factory=dict)


class Subject(Protocol):
    """What routines are of."""

    @property
    def stem(self) -> str:
        """Start of the symbols."""

    def routine_stem(self, output: str) -> str:
        """The symbol of a routine without its storage ending."""

    def part(self, kind: int) -> Subject:
        """What the instances of a kind are, where the routines are loops."""

    def argument(self, argument: Argument) -> Words:
        """Axes, unit and parts of an argument."""

    def output(self, output: Result) -> Words:
        """Axes, unit and parts of an output."""

    def brief(self, output: str) -> str:
        """What a routine does, in a line."""

    def details(self, output: str, program: Program | Looped, preparation: Preparation | None) -> Sequence[str]:
        """What a user must know besides, sentence by sentence."""

    def record(self) -> dict[str, Any]:
        """What the manifest says of the subject."""


@dataclass(frozen=True, slots=True)
class Routine:
    """One program under one name.

    Attributes:
        subject: what it is a routine of.
        output: a quantity, ``all``, or ``prepare``.
        program: what it evaluates: straight-line code, or loops.
        counts: operations of the program.
        equations: where the formulas come from.
        preparation: what the routine takes, or computes, in the place of the geometry; None for run-time geometry.
    """

    subject: Subject
    output: str
    program: Program | Looped
    counts: Counts
    equations: str
    preparation: Preparation | None = None

    @property
    def straight(self) -> Program:
        """The program of straight-line code.

        Raises:
            InternalError: it is loops.
        """
        if isinstance(self.program, Looped):
            raise InternalError(f"{self.symbol} is no straight-line code")
        return self.program

    @property
    def prepared_members(self) -> tuple[Member, ...]:
        """Parts of the array ``prepared``; none for run-time geometry."""
        return self.preparation.members if self.preparation else ()

    @property
    def is_matrix(self) -> bool:
        """Whether an output has a sparsity pattern, so that there are entries for nonzeros and dense storage."""
        return any(output.sparsity.ncol > 1 for output in self.program.outputs)

    @property
    def symbol(self) -> str:
        """The C symbol of the entry that stores nonzeros (or the vector)."""
        stem = self.subject.routine_stem(self.output)
        return f"{stem}_nz" if self.is_matrix and self.output != "all" else stem

    @property
    def dense_symbol(self) -> str:
        """The C symbol of the entry that stores dense matrices."""
        return f"{self.subject.stem}_{self.output}_dense"
