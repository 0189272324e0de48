"""Whether a chain can stand at t = 0 as its file says, before routines are made of it."""

from __future__ import annotations

from codegen.chains.directions import check_springs
from codegen.chains.generated import Generated
from codegen.chains.interpreted import interpreted
from codegen.chains.mechanism import Mechanism, mechanism
from codegen.chains.path import Branch
from codegen.chains.start import coordinates, freedom, start
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
    free, named = freedom(ready, closed.q), len(ready.part.v)
    if named > free:
        what = f"the cuts leave {free} free, and coordinates that are said to be independent: {named}"
        raise SpecificationError([Mistake("independent", what, f"name {free}")])
