"""Independent coordinates of a chain that comes from a scene: chosen by the Jacobian of the cuts at t = 0."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

import numpy as np
import scipy.linalg

from codegen.chains.factor import RANK_TOLERANCE
from codegen.chains.generated import Generated
from codegen.chains.interpreted import interpreted
from codegen.chains.mechanism import characteristic_length
from codegen.spec.chain import Chain
from codegen.spec.chain_motions import Harmonic, Independent, Polynomial
from codegen.spec.scene import Drive

_LATE = 1e-3
"""Factor of the columns of driven coordinates: they are taken as dependent last."""


def independents(chain: Chain, driven: Mapping[str, tuple[Fraction, Drive | None]]) -> tuple[Independent, ...]:
    """Choose independent coordinates, those that are driven first.

    Args:
        chain: its cuts are closed, or nearly so.
        driven: link -> constant part of its coordinate, and the drive.
    """
    names = [link.name for link in chain.links]
    dependent = _dependent(chain, driven) if chain.cuts else set()
    return tuple(_independent(name, driven) for k, name in enumerate(names) if k not in dependent)


def _dependent(chain: Chain, driven: Mapping[str, object]) -> set[int]:
    """The pivots of J: as many coordinates as its rank."""
    q = np.array([float(link.coordinate) for link in chain.links])
    length = characteristic_length(chain)
    J = Generated(chain, False, interpreted).jacobian(q)
    J = J / np.tile([length] * 3 + [1.0] * 3, len(chain.cuts))[:, None]
    J *= [length if link.unit == "m" else 1.0 for link in chain.links]
    J *= [_LATE if link.name in driven else 1.0 for link in chain.links]
    _, R, order = scipy.linalg.qr(J, mode="economic", pivoting=True)
    sizes = np.abs(np.diag(R))
    rank = int((sizes > RANK_TOLERANCE * sizes.max(initial=0.0)).sum())
    return {int(k) for k in order[:rank]}


def _independent(name: str, driven: Mapping[str, tuple[Fraction, Drive | None]]) -> Independent:
    offset, drive = driven.get(name, (Fraction(0), None))
    if drive is None:
        return Independent(name)
    start = offset + drive.position
    if not drive.amplitude:
        return Independent(name, Polynomial((start, drive.speed)), driven=True)
    sine = Harmonic(start, drive.amplitude, drive.frequency, drive.phase, drive.speed)
    return Independent(name, sine, driven=True)
