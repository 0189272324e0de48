"""Order the instructions so that units of a processor, which add, multiply and divide at the same time, alternate.

As `codegen.passes.overlap` it issues, cycle by cycle, the first instruction in the given order whose operands have
come; but of each kind only one a cycle, and a division or a root keeps the divider busy. So additions and
multiplications alternate, and roots are spread among them. The model is a processor that works on vectors of 32 bytes
in halves.
"""

from __future__ import annotations

from heapq import heappop, heappush

from codegen.ir.ops import Op
from codegen.ir.program import Program
from codegen.passes.overlap import dependencies
from codegen.passes.rewrite import reorder

_UNIT = {
    **dict.fromkeys((Op.ADD, Op.SUBTRACT), "adder"),
    **dict.fromkeys((Op.MULTIPLY, Op.FMA, Op.SELECT), "multiplier"),
    **dict.fromkeys((Op.DIVIDE, Op.SQRT), "divider"),
}

_LATENCY = {Op.ADD: 3, Op.SUBTRACT: 3, Op.MULTIPLY: 4, Op.FMA: 5, Op.DIVIDE: 13, Op.SQRT: 20, Op.SELECT: 2}

_BUSY = {Op.DIVIDE: 9, Op.SQRT: 16}
"""Cycles from a division or root to the next; of other operations one starts every cycle."""


def alternate(program: Program) -> Program:
    """Give the program in an order that keeps all units at work; unused instructions are dropped.

    Args:
        program: in an order that keeps few values alive (`codegen.passes.schedule`): its parts stay together.
    """
    uses, missing = dependencies(program)
    coming = [(0, place) for place, count in enumerate(missing) if count == 0]
    ready: dict[str, list[int]] = {"": [], "adder": [], "multiplier": [], "divider": []}
    free = dict.fromkeys(ready, 0)
    arrival = [0] * len(missing)
    order: list[int] = []
    cycle = 0
    while coming or any(ready.values()):
        while coming and coming[0][0] <= cycle:
            place = heappop(coming)[1]
            heappush(ready[_UNIT.get(program.instructions[place].op, "")], place)
        open_units = [unit for unit, places in ready.items() if places and free[unit] <= cycle]
        if not open_units:
            cycle += 1
            continue
        unit = min(open_units, key=lambda name: ready[name][0])
        place = heappop(ready[unit])
        op = program.instructions[place].op
        order.append(place)
        if unit:
            free[unit] = cycle + _BUSY.get(op, 1)
        for use in uses[place]:
            missing[use] -= 1
            arrival[use] = max(arrival[use], cycle + _LATENCY.get(op, 0))
            if missing[use] == 0:
                heappush(coming, (arrival[use], use))
    return reorder(program, order)
