"""Velocities and accelerations of links from those of the joints, link by link from the base."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from codegen.spec.chain import BASE, Chain

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Twist:
    """Motion of a body at [k] times, axes of the base.

    Attributes:
        v: [k, 3] m/s, of its origin.
        w: [k, 3] rad/s.
        a: [k, 3] m/s^2, of its origin.
        al: [k, 3] rad/s^2.
    """

    v: Array
    w: Array
    a: Array
    al: Array

    def at(self, arm: Array) -> Twist:
        """The same body at another point, [k, 3] m from its origin."""
        v = self.v + np.cross(self.w, arm)
        a = self.a + np.cross(self.al, arm) + np.cross(self.w, np.cross(self.w, arm))
        return Twist(v, self.w, a, self.al)


def twists(chain: Chain, frames: Array, qd: Array, qdd: Array) -> dict[str, Twist]:
    """Find the motion of all links, at the origins of their frames.

    Args:
        chain: with a fixed base.
        frames: [k, nf, 3, 4] of links first.
        qd: [k, n].
        qdd: [k, n].
    """
    still = np.zeros((len(qd), 3))
    found = {BASE: Twist(still, still, still, still)}
    origins = {BASE: still}
    for k, link in enumerate(chain.links):
        origins[link.name], axis = frames[:, k, :, 3], frames[:, k, :, 2]
        carrier = found[link.parent].at(origins[link.name] - origins[link.parent])
        rate, change = qd[:, k, None] * axis, qdd[:, k, None] * axis
        turned = np.cross(carrier.w, rate)
        v, w, a, al = carrier.v, carrier.w, carrier.a, carrier.al
        if link.type != "revolute":
            advance = float(link.pitch) if link.type == "screw" else 1.0
            v, a = v + advance * rate, a + advance * (change + 2 * turned)
        if link.type != "prismatic":
            w, al = w + rate, al + change + turned
        found[link.name] = Twist(v, w, a, al)
    return found
