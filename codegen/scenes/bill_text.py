"""The bill of a scene in words and as a table."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from codegen.measure.evaluations import Measurement
from codegen.scenes.bill import Bill
from codegen.scenes.markdown import table
from flopcount.counts import Counts

BUSY = 0.1
"""Spread of times above which a machine is called busy."""


def bill_table(bill: Bill, measurement: Measurement | None) -> str:
    """Write the steps with what each saves, and what each takes if that was measured."""
    head, columns = ["step", "operations", "saved"], [[item.words for item in bill.items]]
    operations = [plain(item.counts) for item in bill.items]
    columns += [[str(number) for number in operations], _saved(operations)]
    if any(trigonometric(item.counts) for item in bill.items):
        head.append("sines and cosines")
        columns.append([str(trigonometric(item.counts)) for item in bill.items])
    if measurement:
        counted = [evaluation.instructions for evaluation in measurement.evaluations]
        if not measurement.uncounted:
            head += ["instructions", "saved"]
            columns += [[str(number) for number in counted], _saved([number or 0 for number in counted])]
        head += ["ns", "saved", "spread"]
        times = [evaluation.nanoseconds for evaluation in measurement.evaluations]
        columns += [[f"{time:.1f}" for time in times], _saved_time(times)]
        columns.append([f"{evaluation.spread:.0%}" for evaluation in measurement.evaluations])
    return table(head, zip(*columns, strict=True))


def plain(counts: Counts) -> int:
    """Operations without sines and cosines, which stand apart."""
    return counts.total - trigonometric(counts)


def trigonometric(counts: Counts) -> int:
    """Sines and cosines; a pair of one angle counts once."""
    return counts.sincos + counts.sin + counts.cos


def bill_lines(bill: Bill, measurement: Measurement | None) -> list[str]:
    """Say what the numbers are, sentence by sentence."""
    return [*_of_plane(bill), *(_of_measurement(measurement) if measurement else _unmeasured())]


def _of_plane(bill: Bill) -> Iterator[str]:
    if bill.in_plane is not None:
        number = trigonometric(bill.in_plane)
        besides = f" and {number} sines and cosines" if number else ""
        yield f'With `motion = "planar"` in the file they would be {plain(bill.in_plane)} operations{besides}.'


def _unmeasured() -> Iterator[str]:
    yield "`jointgen scene FILE -o DIR --measure` adds what each step takes on your machine."


def _of_measurement(measurement: Measurement) -> Iterator[str]:
    yield f"Measured on {measurement.machine} with {measurement.compiler}:"
    yield "the median time of one evaluation, and how far the middle half of all times spreads beside it."
    yield "Single joints, and equal parts, are called one after the other, each over arrays of its own; what several"
    yield "joints give for the same bodies is added up."
    if measurement.uncounted:
        yield f"Instructions are not told: {measurement.uncounted}."
    worst = max(evaluation.spread for evaluation in measurement.evaluations)
    if worst > BUSY:
        yield f"The machine was busy meanwhile (spread up to {worst:.0%}): measure again when it is quiet."


def _saved(numbers: list[int]) -> list[str]:
    return ["", *(str(before - after) for before, after in pairwise(numbers))]


def _saved_time(times: list[float]) -> list[str]:
    return ["", *(f"{before - after:.1f}" for before, after in pairwise(times))]
