"""A step of inverse dynamics as Python drives it: that of the run time, and the pseudo-inverse of all rows in numpy."""

from __future__ import annotations

import timeit
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from codegen.chains.generated import Generated
from codegen.chains.mechanism import Mechanism, mechanism
from codegen.chains.reduced import reduced
from codegen.spec.chain import Chain

Array = NDArray[np.float64]

_REPETITIONS = 200
_ROUNDS = 9


@dataclass(frozen=True, slots=True)
class Driven:
    """Microseconds of one step, the fastest of the rounds.

    Attributes:
        run_time: `codegen.chains.reduced`.
        pseudo_inverse: the same routines, `numpy.linalg.pinv` of all six rows of each cut.
    """

    run_time: float
    pseudo_inverse: float


def driven(chain: Chain) -> Driven:
    """Time both in the pose of the chain's file."""
    ready = mechanism(chain, Generated(chain))
    q = np.array([float(link.coordinate) for link in chain.links])
    sides = (lambda: _run_time(ready, q), lambda: _pseudo_inverse(ready, q))
    with threadpool_limits(1):
        times = np.array([[_microseconds(side) for side in sides] for _ in range(_ROUNDS)])
    return Driven(*map(float, times.min(axis=0)))


def _microseconds(side: Callable[[], object]) -> float:
    return 1e6 * timeit.timeit(side, number=_REPETITIONS) / _REPETITIONS


def _run_time(ready: Mechanism, q: Array) -> tuple[Array, Array]:
    ones, none = np.ones(len(ready.part.v)), np.zeros(len(q))
    found = reduced(ready.equations, ready.part, q, ones)
    qdd = found.rates.acceleration(ones)
    return found.inverse(qdd, none), found.reaction(qdd, none)


def _pseudo_inverse(ready: Mechanism, q: Array) -> tuple[Array, Array]:
    v, w, equations = ready.part.v, ready.part.w, ready.equations
    ones, N = np.ones(len(v)), np.zeros((len(q), len(v)))
    J = equations.jacobian(q)
    inverse = np.linalg.pinv(J[:, w])
    N[v, np.arange(len(v))] = 1.0
    N[w] = -inverse @ J[:, v]
    terms = equations.terms(q, N @ ones)
    qdd = N @ ones
    qdd[w] -= inverse @ terms.gamma
    missing = terms.M @ qdd + terms.f_C - terms.f_G
    return N.T @ missing, inverse.T @ missing[w]
