"""The truth: the independent reference of the tests, evaluated with Arb at 128 bits, at poses on and off the manifold.

The poses of a joint are the columns of the timing as well. Truth is kept as a pair of doubles, so that an error of a
double can be told to far below its rounding.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import flint
import numpy as np
from numpy.typing import NDArray

from benchmarks.peers.work import OUTPUTS, Work
from tests.reference import constraints, derivatives, poses

POSES = 32
PRECISION = 128
TOLERANCE = 1e-11
"""Largest error of a right candidate, relative to the block's scale."""

Values = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Truth:
    """Inputs and true outputs at all poses.

    Attributes:
        inputs: argument -> [poses, length], matrices column-major.
        high: output -> [poses, rows, columns]: the nearest doubles.
        low: output -> what the nearest doubles leave over.
    """

    inputs: Mapping[str, Values]
    high: Mapping[str, Values]
    low: Mapping[str, Values]

    def error(self, work: Work, stored: Mapping[str, Values]) -> float:
        """Largest error of stored outputs, relative to the scale of each 3 x 3 block (phi: of all rows).

        The scale of a block is its largest true entry over all poses. Entries outside the pattern count as zeros.

        Args:
            work: patterns.
            stored: output -> [poses, stored entries].
        """
        return max(self._error(work, name, stored[name]) for name in OUTPUTS)

    def _error(self, work: Work, name: str, stored: Values) -> float:
        pattern = work.patterns[name]
        dense = np.zeros_like(self.high[name])
        for k, (row, column) in enumerate(pattern.places):
            dense[:, row, column] = stored[:, k]
        if not np.all(np.isfinite(dense)):
            return float("inf")
        errors = np.abs((dense - self.high[name]) - self.low[name])
        height = 3 if name == "phi_q_t_lambda_q" else pattern.rows
        width = 3 if pattern.columns > 1 else 1
        largest = 0.0
        for row in range(0, pattern.rows, height):
            for column in range(0, pattern.columns, width):
                block = np.s_[:, row : row + height, column : column + width]
                scale = float(np.abs(self.high[name][block]).max())
                largest = max(largest, float(errors[block].max()) / (scale if scale > 1e-9 else 1.0))
        return largest


def truth(joint: str) -> Truth:
    """Evaluate a joint at its poses, every other one on the manifold."""
    flint.ctx.prec = PRECISION
    samples = [poses.sample(joint, "conventional", seed, consistent=seed % 2 == 0) for seed in range(POSES)]
    exact = [_evaluate(joint, poses.convert(sample, flint.arb(0))) for sample in samples]
    high = {name: np.array([_floats(values[name]) for values in exact]) for name in OUTPUTS}
    low = {
        name: np.array([_floats(values[name] - _arb(high[name][k])) for k, values in enumerate(exact)])
        for name in OUTPUTS
    }
    names = ("r_i", "A_i", "r_j", "A_j", "geometry", "lambda")
    inputs = {name: np.array([np.asarray(sample[name]).ravel(order="F") for sample in samples]) for name in names}
    return Truth(inputs, high, low)


def _evaluate(joint: str, inputs: Mapping[str, Any]) -> dict[str, Any]:
    pose, geometry = derivatives.pose_of(inputs), constraints.unpack_geometry(inputs["geometry"])
    first, second = derivatives.tensors(joint, "conventional", None, pose, geometry)
    values = constraints.phi(joint, "conventional", None, pose, geometry)
    weighted = np.tensordot(inputs["lambda"], second, axes=(0, 0)).T
    return dict(zip(OUTPUTS, (values[:, np.newaxis], first, weighted), strict=True))


def _floats(values: Any) -> Values:
    return np.array([[float(x) for x in row] for row in values])


def _arb(values: Values) -> Any:
    return np.array([[flint.arb(float(x)) for x in row] for row in values])
