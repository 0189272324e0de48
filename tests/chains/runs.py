"""Runs of the mechanisms, and their references."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from codegen.chains import forward, prescribed
from codegen.chains.equations import Equations
from codegen.chains.generated import Generated
from codegen.chains.mechanism import Mechanism, mechanism
from codegen.chains.motion import drives, motions
from codegen.chains.run import Run
from codegen.chains.simulate import initial
from codegen.chains.start import start
from codegen.measure.threads import one_thread
from codegen.spec.chain import Chain

from .table import TableEquations

Array = NDArray[np.float64]


@cache
def generated(chain: Chain) -> Mechanism:
    """A chain by its compiled routines."""
    return mechanism(chain, Generated(chain))


def by_table(chain: Chain) -> Mechanism:
    """A chain by its table: nothing is generated or compiled."""
    equations: Equations = TableEquations(chain)
    return mechanism(chain, equations)


def prescribed_run(ready: Mechanism, times: Array, is_inverse: bool = True) -> Run:
    """Kinematics or inverse dynamics by the motion of the chain."""
    given = motions(ready.chain, {}, float(times[-1]))
    with one_thread():
        return prescribed.run(ready, given, start(ready, given.at(float(times[0]))[0]), times, is_inverse)


def forward_run(ready: Mechanism, times: Array, tolerance: float) -> Run:
    """Forward dynamics."""
    q_v, qd_v = initial(ready, {})
    with one_thread():
        given = drives(ready.chain, {}, float(times[-1]))
        return forward.run(ready, start(ready, q_v), qd_v, given, times, tolerance)
