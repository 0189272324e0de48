"""Springs of a chain whose force has no direction at t = 0: their ends coincide there."""

from __future__ import annotations

import numpy as np

from codegen.chains.generated import Generated
from codegen.errors import Mistake, SpecificationError
from codegen.spec.chain import Chain

_CLOSE = 1e-12
"""m."""


def check_springs(chain: Chain, equations: Generated) -> None:
    """Refuse springs that have a length or a damper and whose ends coincide.

    Args:
        chain: the chain, with the coordinates of its rows.
        equations: of the chain.

    Raises:
        SpecificationError: all such springs.
    """
    if not chain.springs:
        return
    frames = equations.frames(np.array([float(link.coordinate) for link in chain.links]))
    first = len(chain.links) + 2 * len(chain.cuts)
    ends = {effector.name: frames[first + k, :, 3] for k, effector in enumerate(chain.effectors)}
    mistakes = []
    for spring in chain.springs:
        one, other = (ends[name] for name in spring.effectors)
        if (spring.length or spring.damping) and float(np.linalg.norm(other - one)) < _CLOSE:
            place = f'spring between "{spring.effectors[0]}" and "{spring.effectors[1]}"'
            what = "its ends coincide at t = 0, where its force has no direction"
            mistakes.append(Mistake(place, what, "move an end, or give length = 0 and damping = 0"))
    if mistakes:
        raise SpecificationError(mistakes)
