"""The three figures of an output block: error over its scale, error over that of rounded inputs (eta), ULP."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from codegen.ir.evaluate import evaluate
from codegen.ir.program import Program
from codegen.measure.condition import condition
from codegen.measure.double_double import DoubleDouble, double_double_domain
from codegen.measure.pose_domain import Block, PoseDomain
from codegen.measure.poses import Poses, exactly, in_pairs

Array = NDArray[np.float64]
Values = Mapping[str, NDArray[np.floating]]
"""Output -> [nonzeros, poses]."""

_REALS: dict[str, type[np.floating]] = {"double": np.float64, "float": np.float32, "long double": np.longdouble}


def number_type(real: str) -> type[np.floating]:
    """The numpy type of ``double``, ``float`` or ``long double``."""
    return _REALS[real]


def unit_roundoff(real: str) -> float:
    """Half the distance of 1 and the next number."""
    return float(np.finfo(_REALS[real]).eps) / 2


@dataclass(frozen=True, slots=True, eq=False)
class Truth:
    """What a routine should give at rounded inputs, and what the ideal geometry would give.

    Attributes:
        real: number type of the inputs.
        inputs: argument -> [length, poses], as the routine gets them.
        of_inputs: output -> entries at these inputs.
        ideal: output -> entries at the ideal geometry.
        condition: output -> [nonzeros, poses], see `codegen.measure.condition`.
    """

    real: str
    inputs: dict[str, NDArray[np.floating]]
    of_inputs: dict[str, list[DoubleDouble]]
    ideal: dict[str, list[DoubleDouble]]
    condition: dict[str, Array]


def truth(program: Program, poses: Poses, real: str) -> Truth:
    """Evaluate a program in twice the precision of doubles at rounded and at ideal inputs."""
    used = {argument.name for argument in program.used_arguments()}
    given = {name: rows for name, rows in poses.given(_REALS[real]).items() if name in used}
    domain = double_double_domain()
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        of_inputs = evaluate(program, exactly(given), domain)
        ideal = evaluate(program, poses.ideal, domain)
    in_doubles = {name: rows.astype(np.float64) for name, rows in given.items()}
    return Truth(real, given, of_inputs, ideal, condition(program, in_doubles))


@dataclass(frozen=True, slots=True)
class Figures:
    """The figures of one block over all poses.

    Attributes:
        block: its name.
        scale: what the errors are divided by.
        largest: error against the given inputs over the scale, maximum.
        mean: the same, mean.
        worst_pose: number of the pose of the maximum.
        floor: distance of the two truths over the scale, maximum: what better arithmetic cannot mend.
        eta: largest error in the block over the largest that rounding the inputs makes in it, maximum over the poses.
        eta_entry: the same entry by entry; it depends on the choice of axes, since an entry that is small by chance may
            stand beside large ones from which it is computed.
        ulp_median: error in units in the last place of the true value, median.
        ulp_99: the same, 99 of 100 are below it.
    """

    block: str
    scale: float
    largest: float
    mean: float
    worst_pose: int
    floor: float
    eta: float
    eta_entry: float
    ulp_median: float
    ulp_99: float


def figures(known: Truth, values: Values, blocks: Sequence[Block], domain: PoseDomain) -> tuple[Figures, ...]:
    """Judge values of a routine block by block.

    Args:
        known: the truth, at the inputs that the routine got.
        values: what it gave.
        blocks: what is judged.
        domain: for the scales.
    """
    return tuple(_of_block(known, values, block, domain) for block in blocks)


def errors_of(known: Truth, values: Values, block: Block) -> Array:
    """Errors [entries, poses] against the given inputs."""
    found = values[block.output]
    true = known.of_inputs[block.output]
    return np.array([np.abs((in_pairs(found[entry]) - true[entry]).high) for entry in block.entries])


def _of_block(known: Truth, values: Values, block: Block, domain: PoseDomain) -> Figures:
    scale, unit = domain.scale(block.output, block.is_rotation), unit_roundoff(known.real)
    error = errors_of(known, values, block)
    true, ideal = ([truths[block.output][k] for k in block.entries] for truths in (known.of_inputs, known.ideal))
    floors = [np.max(np.abs((a - b).high)) for a, b in zip(true, ideal, strict=True)]
    sizes = np.array([np.abs(x.high) + np.zeros(error.shape[1]) for x in true])
    rounding = unit * known.condition[block.output][list(block.entries)]
    ulps = _ratio(error, np.spacing(sizes) * (unit / unit_roundoff("double")))
    per_pose = np.max(error, axis=0) / scale
    return Figures(
        block.name,
        scale,
        float(np.max(per_pose)),
        float(np.mean(error)) / scale,
        int(np.argmax(per_pose)),
        float(np.max(floors)) / scale,
        float(np.max(_ratio(np.max(error, axis=0), np.max(rounding, axis=0)))),
        float(np.max(_ratio(error, rounding))),
        float(np.median(ulps)),
        float(np.quantile(ulps, 0.99)),
    )


def _ratio(error: Array, unit: Array) -> Array:
    """Error in units; no error is none, whatever the unit."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(error == 0, 0.0, error / unit)
