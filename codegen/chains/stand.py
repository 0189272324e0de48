"""Whether a chain can stand at t = 0 as its file says, before routines are made of it."""

from __future__ import annotations

import numpy as np

from codegen.chains.directions import check_springs
from codegen.chains.factor import RANK_TOLERANCE
from codegen.chains.generated import Generated
from codegen.chains.interpreted import interpreted
from codegen.chains.mechanism import Mechanism, mechanism
from codegen.chains.path import Branch
from codegen.chains.start import coordinates, start
from codegen.errors import Mistake, SpecificationError
from codegen.spec.chain import Chain


def check_start(chain: Chain) -> None:
    """Refuse a chain that cannot stand at t = 0.

    Raises:
        SpecificationError: cuts are open or cannot be closed, or the independent coordinates do not determine the
            others, or are not independent; springs have no direction.
    """
    equations = Generated(chain, False, interpreted)
    check_springs(chain, equations)
    ready = mechanism(chain, equations)
    closed = start(ready, coordinates(ready)[ready.part.v])
    _check_freedom(ready, closed)


def _check_freedom(ready: Mechanism, closed: Branch) -> None:
    """Refuse more independent coordinates than the cuts leave free."""
    if not ready.chain.cuts:
        return
    part, size = ready.part, len(ready.chain.links)
    J = ready.equations.jacobian(closed.q)[part.rows] * part.units / part.row_units[part.rows, None]
    values = np.linalg.svd(J, compute_uv=False)
    rank = int((values > RANK_TOLERANCE * values.max(initial=0.0)).sum())
    if rank > len(part.w):
        what = f"the cuts leave {size - rank} free, and coordinates that are said to be independent: {len(part.v)}"
        raise SpecificationError([Mistake("independent", what, f"name {size - rank}")])
