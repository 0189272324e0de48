"""Measure all candidates of one joint: compile, check, count, time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmarks.peers.candidates import Candidate
from benchmarks.peers.compile import CompilationError, Compiled, Setting, compile_all, compiled, operations
from benchmarks.peers.harness import build
from benchmarks.peers.oracle import TOLERANCE, Truth
from benchmarks.peers.work import Work

PASSES = 8
LINK_ORDERS = 4
"""Harnesses linked in different orders, since the place of code in memory shifts its time by some percent."""

Log = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class Timing:
    """One candidate with one compiler and its flags.

    Attributes:
        error: largest error, relative to the scale of the block.
        compile_seconds: of the processor, for its translation unit.
        ns: median time per call; None if the candidate is wrong.
        spread: interquartile range, ns.
        instructions: executed per call; None where it is wrong or there is no valgrind.
    """

    error: float
    compile_seconds: float
    ns: float | None
    spread: float | None
    instructions: float | None


@dataclass(frozen=True, slots=True)
class Measured:
    """One candidate.

    Attributes:
        candidate: which.
        operations: kind -> number, by the object code; None where they cannot be counted.
        timings: setting -> timing; a setting is missing if the candidate does not compile.
    """

    candidate: Candidate
    operations: dict[str, int] | None
    timings: dict[str, Timing]


def measure(
    work: Work,
    truth: Truth,
    candidates: Sequence[Candidate],
    settings: Sequence[Setting],
    rounds: int,
    count_instructions: bool,
    log: Log,
) -> list[Measured]:
    """Measure the candidates of a joint with every setting."""
    timings: dict[str, dict[str, Timing]] = {candidate.symbol: {} for candidate in candidates}
    compile_all(candidates, settings)
    for setting in settings:
        made = _compiled(candidates, setting, log)
        for candidate, timing in _timed(work, truth, made, rounds, count_instructions, log).items():
            timings[candidate][str(setting)] = timing
    return [Measured(c, operations(c), timings[c.symbol]) for c in candidates]


def _compiled(candidates: Sequence[Candidate], setting: Setting, log: Log) -> list[Compiled]:
    made = []
    for candidate in candidates:
        try:
            made.append(compiled(candidate, setting))
        except CompilationError as error:
            log(f"{candidate.name} ({candidate.form}) with {setting}: {error}")
    return made


def _timed(
    work: Work, truth: Truth, made: list[Compiled], rounds: int, count_instructions: bool, log: Log
) -> dict[str, Timing]:
    outputs = build(work, made, truth, f"{work.joint}_check").outputs()
    errors = [0.0 if c.candidate.name == "floor" else truth.error(work, o) for c, o in zip(made, outputs, strict=True)]
    right = [c for c, error in zip(made, errors, strict=True) if error < TOLERANCE]
    for c, error in zip(made, errors, strict=True):
        if error >= TOLERANCE:
            log(f"{c.candidate.name} ({c.candidate.form}) is wrong for {work.joint}: error {error:.1e}; not timed")
    samples = _samples(work, truth, right, rounds)
    counts = build(work, right, truth, f"{work.joint}_count").instructions() if count_instructions else None
    instructions = {c.candidate.symbol: n for c, n in zip(right, counts or [], strict=False)}
    result = {}
    for c, error in zip(made, errors, strict=True):
        symbol = c.candidate.symbol
        median, spread = _quartiles(samples[symbol]) if symbol in samples else (None, None)
        result[symbol] = Timing(error, c.seconds, median, spread, instructions.get(symbol))
    return result


def _quartiles(values: NDArray[np.float64]) -> tuple[float, float]:
    """Median and interquartile range."""
    low, median, high = (float(x) for x in np.percentile(values, [25, 50, 75]))
    return median, high - low


def _samples(work: Work, truth: Truth, right: list[Compiled], rounds: int) -> dict[str, NDArray[np.float64]]:
    """Times of each candidate, ns per call, pooled over several orders of linking."""
    pooled: dict[str, list[NDArray[np.float64]]] = {c.candidate.symbol: [] for c in right}
    generator = np.random.default_rng(0)
    for order in range(LINK_ORDERS):
        shuffled = [right[k] for k in generator.permutation(len(right))]
        harness = build(work, shuffled, truth, f"{work.joint}_{order}")
        times = harness.times(max(1, rounds // LINK_ORDERS), PASSES)
        for k, c in enumerate(shuffled):
            pooled[c.candidate.symbol].append(times[:, k])
    return {symbol: np.concatenate(parts) for symbol, parts in pooled.items()}
