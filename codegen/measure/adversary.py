"""Look for the largest rounding errors: from sampled points uphill, in small and large random steps.

The search is local and finds lower limits of the worst error, where `codegen.measure.bounds` proves upper ones. It is
the same in every run.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Judge = Callable[[Array], Array]
"""Points [n, dimensions] of the unit cube -> errors [blocks, n]."""

SEED = 7
_PARENTS = 8
_CHILDREN = 32
_STEPS = (0.1, 1e-2, 1e-4, 1e-7)
"""Of the unit cube: the last ones only change how numbers round."""


@dataclass(frozen=True, slots=True, eq=False)
class Found:
    """The worst that was found for each block.

    Attributes:
        sampled: [blocks] largest error at the given points.
        searched: [blocks] largest error.
        points: [blocks, dimensions] where.
    """

    sampled: Array
    searched: Array
    points: Array


def searched(judge: Judge, points: Array, rounds: int = 8) -> Found:
    """Search uphill from the worst of some points, for every block.

    Args:
        judge: gives the errors.
        points: [n, dimensions] where to start.
        rounds: generations.
    """
    random = np.random.default_rng(SEED)
    errors = judge(points)
    sampled = np.max(errors, axis=1)
    elite = [_best(points, row) for row in errors]
    for round_ in range(rounds):
        step = _STEPS[round_ * len(_STEPS) // rounds]
        tries = np.concatenate([_children(random, parents, step) for parents, _ in elite])
        errors = judge(tries)
        elite = [
            _best(np.concatenate([parents, tries]), np.concatenate([known, row]))
            for (parents, known), row in zip(elite, errors, strict=True)
        ]
    return Found(sampled, np.array([known[0] for _, known in elite]), np.array([parents[0] for parents, _ in elite]))


def _best(points: Array, errors: Array) -> tuple[Array, Array]:
    order = np.argsort(-errors, kind="stable")[:_PARENTS]
    return points[order], errors[order]


def _children(random: np.random.Generator, parents: Array, step: float) -> Array:
    """Steps from each parent, in a random half of the dimensions."""
    chosen = np.repeat(parents, _CHILDREN // len(parents) + 1, axis=0)
    moved = random.random(chosen.shape) < 0.5
    return np.clip(chosen + step * moved * random.uniform(-1, 1, chosen.shape), 0.0, np.nextafter(1.0, 0.0))
