"""CasADi's virtual machine: our function beside CasADi's own derivatives, evaluated as CasADi evaluates them.

Each function is mapped over the poses in series and called through a buffer, so that one call from Python evaluates it
many times. Instructions are CasADi's own count, loads of inputs and stores of outputs included.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import casadi
import numpy as np

from benchmarks.peers import peer_casadi
from benchmarks.peers.oracle import POSES, TOLERANCE, Truth
from benchmarks.peers.work import Work

_COPIES = 16
_FREE = (casadi.OP_INPUT, casadi.OP_OUTPUT, casadi.OP_CONST, casadi.OP_NEG, casadi.OP_ASSIGN)


@dataclass(frozen=True, slots=True)
class VirtualTime:
    """A function in the virtual machine.

    Attributes:
        name: ``ours`` or ``casadi``.
        form: in which form CasADi was fed.
        instructions: CasADi's count.
        operations: instructions without loads, stores, constants and changes of sign.
        error: largest error, relative to the scale of the block.
        ns: median time per evaluation; None if the function is wrong.
        spread: interquartile range, ns.
    """

    name: str
    form: str
    instructions: int
    operations: int
    error: float
    ns: float | None
    spread: float | None


class _Mapped:
    """A function mapped over the poses, with its buffers."""

    def __init__(self, function: Any, truth: Truth) -> None:
        self.function = function
        mapped = function.map(POSES * _COPIES, "serial")
        self._buffer, self.evaluate = mapped.buffer()
        self._mapped = mapped
        names = function.name_in()
        self._inputs = [np.ascontiguousarray(np.tile(truth.inputs[name], (_COPIES, 1))) for name in names]
        self._outputs = [np.zeros(mapped.nnz_out(k)) for k in range(mapped.n_out())]
        for k, values in enumerate(self._inputs):
            self._buffer.set_arg(k, _memory(values.reshape(-1)))
        for k, values in enumerate(self._outputs):
            self._buffer.set_res(k, _memory(values))

    def error(self, work: Work, truth: Truth) -> float:
        self.evaluate()
        names = self.function.name_out()
        stored = {
            name: values.reshape(POSES * _COPIES, -1)[:POSES] for name, values in zip(names, self._outputs, strict=True)
        }
        return truth.error(work, stored)


def _memory(values: Any) -> memoryview:
    return memoryview(values)


def virtual_times(work: Work, truth: Truth, ours: Mapping[str, Path], rounds: int) -> list[VirtualTime]:
    """Check and time functions, interleaved.

    Args:
        work: of the joint.
        truth: of the joint.
        ours: label -> saved CasADi function of the same work.
        rounds: of the interleaved measurement.
    """
    functions = [(label, "jointgen", casadi.Function.load(str(path))) for label, path in ours.items()]
    functions += [("casadi", form, peer_casadi.function(work, form, "work")) for form in peer_casadi.FORMS]
    mapped = [_Mapped(function, truth) for _, _, function in functions]
    errors = [each.error(work, truth) for each in mapped]
    times: list[list[float]] = [[] for _ in mapped]
    for _ in range(rounds):
        for each, measured in zip(mapped, times, strict=True):
            start = time.perf_counter_ns()
            each.evaluate()
            measured.append((time.perf_counter_ns() - start) / (POSES * _COPIES))
    results = []
    for (name, form, function), error, measured in zip(functions, errors, times, strict=True):
        quartiles = statistics.quantiles(measured, n=4)
        ns, spread = (quartiles[1], quartiles[2] - quartiles[0]) if error < TOLERANCE else (None, None)
        count = _operations(function)
        results.append(VirtualTime(name, form, function.n_instructions(), count, error, ns, spread))
    return results


def _operations(function: Any) -> int:
    return sum(function.instruction_id(k) not in _FREE for k in range(function.n_instructions()))
