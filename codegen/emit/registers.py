"""How often a routine goes to memory, on a model of a processor with sixteen registers.

A compiler keeps an input that it has read, on the stack if there is no register left, unless a store stands between two
uses and may have changed it: then it reads the input again, which takes no store. Which is less depends on the routine.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence

from codegen.ir.ops import LEAVES, Op
from codegen.ir.program import Program

REGISTERS = 16
"""For numbers, on x86-64."""

_NEVER = 1 << 60

_Step = tuple[tuple[int, ...], int | None]
"""Values that are read, and the value that is computed; None where results are stored."""


def is_better_read_again(program: Program, together: int) -> bool:
    """Whether inputs that are read again behind stores make fewer accesses than inputs that are kept.

    Args:
        program: in the order of its statements.
        together: how many results are stored at a time.
    """
    steps = list(_steps(program, together))
    again, kept = (_Registers(program, steps, is_kept).accesses() for is_kept in (False, True))
    return again < kept


def _steps(program: Program, together: int) -> Iterator[_Step]:
    counts: dict[int, int] = defaultdict(int)
    for output in program.outputs:
        for value in output.values:
            counts[value] += 1
    ready: list[int] = []
    for position, instruction in enumerate(program.instructions):
        if instruction.op not in LEAVES:
            yield instruction.operands, position
        ready += [position] * counts[position]
        if len(ready) >= together:
            yield tuple(ready), None
            ready = []
    yield tuple(ready), None


class _Registers:
    """Sixteen registers; what is used latest makes room."""

    def __init__(self, program: Program, steps: Sequence[_Step], is_kept: bool) -> None:
        ops = [instruction.op for instruction in program.instructions]
        variable = {position for position, op in enumerate(ops) if op is not Op.CONSTANT}
        self._steps = [(tuple(v for v in dict.fromkeys(read) if v in variable), made) for read, made in steps]
        self._inputs = {position for position, op in enumerate(ops) if op is Op.INPUT}
        self._is_kept = is_kept
        self._uses: dict[int, list[int]] = defaultdict(list)
        for time in range(len(self._steps) - 1, -1, -1):
            for value in self._steps[time][0]:
                self._uses[value].append(time)
        self._held: set[int] = set()
        self._on_stack: set[int] = set()
        self._count = 0

    def accesses(self) -> int:
        """Reads and writes of memory, but for those of results, which are the same in any case."""
        for read, made in self._steps:
            for value in read:
                self._count += value not in self._held
                self._hold(value)
            for value in read:
                self._uses[value].pop()
                if not self._uses[value]:
                    self._held.discard(value)
            if made is not None and self._uses[made]:
                self._hold(made)
            elif made is None and not self._is_kept:
                self._held -= self._inputs
        return self._count

    def _hold(self, value: int) -> None:
        self._held.add(value)
        if len(self._held) > REGISTERS:
            last = max(self._held - {value}, key=lambda held: (self._next_use(held), held))
            self._held.discard(last)
            if last not in self._on_stack and (self._is_kept or last not in self._inputs):
                self._on_stack.add(last)
                self._count += 1

    def _next_use(self, value: int) -> int:
        return self._uses[value][-1] if self._uses[value] else _NEVER
