"""Split programs by what is known early: values of the geometry alone are computed once, and each step takes them.

Input: programs that share their early arguments, as the routines of one joint share ``geometry``. Output: one program
``prepare`` from the early arguments to the vector ``prepared``, and a step for each program, which takes ``prepared``
in their place. A step does the operations that are left, the same ones in the same order: its results have the same
bits.

What ``prepared`` holds is the least that leaves no operation on early values to a step: the early values that outputs
and operations on later values take, each once; a change of sign is free and stays in the step.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, replace

from codegen.ir.builder import Builder
from codegen.ir.ops import Op
from codegen.ir.program import Argument, Output, Program, Sparsity
from codegen.passes.drop_unused import drop_unused
from codegen.passes.rewrite import Rebuilding
from codegen.passes.schedule import schedule


@dataclass(frozen=True, slots=True)
class Split:
    """What is computed once, and what is left for each step.

    Attributes:
        prepare: early arguments -> the vector ``prepared``: entries of the arguments first, in their order, then named
            values, stage by stage, then the others.
        steps: the programs on ``prepared``, in their order.
    """

    prepare: Program
    steps: tuple[Program, ...]


def split_geometry(
    programs: Sequence[Program], early: Collection[str] = ("geometry",), prepared: str = "prepared"
) -> Split:
    """Split programs with the same arguments into what depends on early ones alone and the rest.

    Args:
        programs: they share one layout of ``prepared``.
        early: names of the arguments that are known beforehand.
        prepared: name of the vector between the two parts.
    """
    programs = [drop_unused(program) for program in programs]
    shared = _Early(early)
    taken = [shared.add(program) for program in programs]
    stored = _layout(shared.builder, dict.fromkeys(place for places in taken for place in places.values()))
    arguments = programs[0].arguments
    pattern = Sparsity.of_entries(len(stored), 1, [(row, 0) for row in range(len(stored))])
    legend = {name: words for program in programs for name, words in program.legend}
    prepare = shared.builder.freeze(
        tuple(argument for argument in arguments if argument.name in early),
        (Output(prepared, pattern, tuple(stored)),),
        legend,
    )
    vector = Argument(prepared, (len(stored), 1))
    index = {place: k for k, place in enumerate(stored)}
    steps = (
        _step(program, {old: index[place] for old, place in places.items()}, early, vector)
        for program, places in zip(programs, taken, strict=True)
    )
    return Split(schedule(prepare), tuple(steps))


class _Early:
    """The early values of all programs, equal ones once."""

    def __init__(self, early: Collection[str]) -> None:
        self.builder = Builder()
        self._early = early

    def add(self, program: Program) -> dict[int, int]:
        """Repeat the early values of a program; gives position in the program -> here of those that a step takes."""
        is_early = early_values(program, self._early)
        places: dict[int, int] = {}
        for position, instruction in enumerate(program.instructions):
            if is_early[position] or instruction.op is Op.CONSTANT:
                operands = tuple(places[operand] for operand in instruction.operands)
                places[position] = self.builder.append(instruction.with_operands(operands))
        return {position: places[position] for position in _taken(program, is_early)}


def early_values(program: Program, early: Collection[str]) -> list[bool]:
    """Say of each instruction whether it depends on early arguments and on nothing else but constants."""
    marks: list[bool] = []
    for instruction in program.instructions:
        if instruction.source is not None:
            marks.append(instruction.source[0] in early)
            continue
        known = [marks[o] or program.instructions[o].op is Op.CONSTANT for o in instruction.operands]
        marks.append(all(known) and any(marks[o] for o in instruction.operands))
    return marks


def _taken(program: Program, is_early: Sequence[bool]) -> Iterable[int]:
    """Early values that later instructions or outputs take, without their signs; in the order of the program."""
    taken = {value for output in program.outputs for value in output.values}
    for position, instruction in enumerate(program.instructions):
        if not is_early[position]:
            taken.update(instruction.operands)
    return sorted({_unsigned(program, value) for value in taken if is_early[value]})


def _unsigned(program: Program, position: int) -> int:
    while program.instructions[position].op is Op.NEGATE:
        position = program.instructions[position].operands[0]
    return position


def _layout(builder: Builder, places: Iterable[int]) -> list[int]:
    """Order the stored values for readers."""
    stages: dict[str, int] = {}
    keyed = []
    for number, place in enumerate(places):
        instruction = builder.instructions[place]
        if instruction.source is not None:
            key = (0, *instruction.source)
        elif instruction.label is not None:
            stage, index = instruction.label
            key = (1, f"{stages.setdefault(stage, len(stages)):06}", index)
        else:
            key = (2, "", number)
        keyed.append((key, place))
    return [place for _, place in sorted(keyed)]


def _step(program: Program, index: dict[int, int], early: Collection[str], vector: Argument) -> Program:
    is_early = early_values(program, early)
    rebuilding = Rebuilding(program)
    for position, instruction in enumerate(program.instructions):
        if position in index:
            rebuilding.put(instruction, rebuilding.builder.input(vector.name, index[position]))
        elif not is_early[position] or _unsigned(program, position) in index:
            rebuilding.copy(instruction)
        else:
            rebuilding.moved.append(_NOWHERE)
    step = rebuilding.finish()
    return drop_unused(replace(step, arguments=_arguments(program.arguments, early, vector)))


_NOWHERE = -1
"""Place of an early value that no step takes."""


def _arguments(arguments: Sequence[Argument], early: Collection[str], vector: Argument) -> tuple[Argument, ...]:
    """Put the prepared vector where the first early argument stood."""
    put: dict[str, Argument] = {}
    for argument in arguments:
        chosen = vector if argument.name in early else argument
        put.setdefault(chosen.name, chosen)
    return tuple(put.values())
