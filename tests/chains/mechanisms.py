"""The two mechanisms of S2 as chains, and others that are awkward."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction as F
from typing import Any

import numpy as np

from codegen.spec.angles import PI
from codegen.spec.chain import BASE, Chain, Cut, Frame, Link, Row
from codegen.spec.chain_forces import Condition, JointForce
from codegen.spec.chain_motions import Independent, Motion, Polynomial
from tests.reference.quick_return import CUT, CUTTING, DRIVE

RIGHT = PI / 2
ZERO = (F(0), F(0), F(0))


def row(**values: Any) -> Row:
    return Row(**{name: F(value) for name, value in values.items()})


def link(
    name: str, parent: str, where: Row, mass: Any = 0, centre: Any = (0, 0, 0), inertia: Any = (0, 0, 0), **more: Any
) -> Link:
    moments = tuple(tuple(F(inertia[i]) if i == j else F(0) for j in range(3)) for i in range(3))
    kind = more.pop("type", "revolute")
    return Link(name, parent, kind, where, F(mass), tuple(map(F, centre)), moments, **more)  # type: ignore[arg-type]


def quick_return(
    J: int = 2000, w: Any = 2 * PI, start: Any = F("0.44"), branch: int = -1, drive: bool = False, scale: int = 1
) -> Chain:
    """The planar quick return; frame 0 stands at the crank's pivot.

    Args:
        J: of the crank.
        w: its speed.
        start: its angle.
        branch: -1: slider left of the rocker's tip.
        drive: whether drive and cutting act, for forward dynamics.
        scale: lengths are given in so many parts of a metre, masses as they are.
    """
    s, ss = F(scale), F(scale) ** 2
    angle = float(start)
    pin = np.array([1.5 * np.cos(angle), 2 + 1.5 * np.sin(angle)])
    span = float(np.hypot(*pin))
    phi = np.arctan2(pin[1], pin[0])
    tip = 4 * pin / span
    reach = branch * np.sqrt(4 - (4 - tip[1]) ** 2)
    chi = np.arctan2(4 - tip[1], reach)
    links = (
        link("crank", BASE, row(theta=start), 1000, inertia=(1, 1, J * ss)),
        link("block", "crank", row(a=F(3, 2) * s, theta=phi - np.pi / 2 - angle), 5, inertia=(1, 1, ss / 2)),
        link(
            "rocker",
            "block",
            row(alpha=-RIGHT, d=-span * scale),
            100,
            (0, 0, 2 * s),
            (1, 100 * ss, 1),
            type="prismatic",
        ),
        link("pivot", "rocker", row(alpha=RIGHT, theta=np.pi / 2 - phi)),
        link(
            "coupler", "rocker", row(c=4 * s, alpha=RIGHT, theta=chi - phi + np.pi / 2), 30, (s, 0, 0), (1, 1, 10 * ss)
        ),
        link("slider", "coupler", row(a=2 * s, theta=-chi), 50, inertia=(1, 1, F(3, 2) * ss)),
        link("slide", "slider", row(psi=-RIGHT, alpha=RIGHT, d=(tip[0] + reach) * scale), type="prismatic"),
    )
    cuts = (
        Cut("rocker bearing", Frame(BASE, row(psi=-RIGHT, a=2 * s, theta=RIGHT)), Frame("pivot", Row())),
        Cut("guide", Frame(BASE, row(psi=-RIGHT, a=-2 * s, alpha=RIGHT)), Frame("slide", Row())),
    )
    cutting = Condition("slide", F(CUTTING[0]) * s, F(str(CUTTING[1])) * s, -1)
    forces = (JointForce("crank", F(DRIVE) * ss), JointForce("slide", F(CUT) * s, when=cutting)) if drive else ()
    crank = Independent("crank", Polynomial((F(start), F(w))))
    return Chain("quick_return", (F(0), -F("9.81") * s, F(0)), links, cuts, (), (crank,), forces)


def spatial_slider_crank(
    length: Any = F("0.27"),
    w: Any = 2 * PI,
    branch: int = 1,
    q: float = 0.0,
    scale: int = 1,
    motion: Motion | None = None,
    forces: tuple[JointForce, ...] = (),
) -> Chain:
    """The spatial slider-crank.

    Args:
        length: of the rod.
        w: speed of the crank.
        branch: side of the slider.
        q: angle of the crank at t = 0, from +z towards +y.
        scale: lengths are given in so many parts of a metre.
        motion: of the crank's coordinate, q - pi/2.
        forces: on the crank.
    """
    s, ss = F(scale), F(scale) ** 2
    L = float(length)
    x_ = np.eye(3)[0]
    arm = np.array([0, np.sin(q), np.cos(q)])
    pin = np.array([0, 0.1, 0.12]) + 0.08 * arm
    aside = np.hypot(pin[1], pin[2])
    x = branch * np.sqrt(max(0.0, L**2 - aside**2))
    along = (np.array([x, 0, 0]) - pin) / np.linalg.norm(np.array([x, 0, 0]) - pin)
    n = np.cross(x_, along) / np.linalg.norm(np.cross(x_, along))
    frames = [
        np.eye(3),
        _frame(arm, -x_),
        _frame(np.cross(-x_, n), -x_),
        _frame(np.cross(n, along), n),
        _frame(np.cross(along, n), along),
        _frame(np.cross(n, -x_), n),
        _frame(np.eye(3)[1], -x_),
    ]
    psis = (RIGHT, 0, 0, 0, 0, 0)
    alphas = (-RIGHT, 0, RIGHT, RIGHT, RIGHT, RIGHT)
    turns = [_theta(frames[k], frames[k + 1], psis[k], alphas[k]) for k in range(6)]
    rod = F(length) * s
    links = (
        link("crank", BASE, row(psi=RIGHT, c=F("0.12") * s, alpha=-RIGHT, a=F("0.1") * s, theta=turns[0]), "0.12",
             inertia=(F("0.00001") * ss, F("0.0001") * ss, F("0.0001") * ss)),
        link("ball 1", "crank", row(a=F("0.08") * s, theta=turns[1])),
        link("ball 2", "ball 1", row(alpha=RIGHT, theta=turns[2])),
        link("rod", "ball 2", row(alpha=RIGHT, theta=turns[3]), "0.5", (0, 0, rod / 2),
             (F("0.004") * ss, F("0.004") * ss, F("0.0004") * ss)),
        link("cross", "rod", row(c=rod, alpha=RIGHT, theta=turns[4])),
        link("slider", "cross", row(alpha=RIGHT, theta=turns[5]), 2, inertia=(F("0.0001") * ss,) * 3),
        link("slide", "slider", row(d=x * scale), type="prismatic"),
    )  # fmt: skip
    cut = Cut("guide", Frame(BASE, row(psi=RIGHT, alpha=-RIGHT)), Frame("slide", Row()))
    crank = Independent("crank", motion or Polynomial((F(q) - RIGHT, F(w))))
    gravity = (F(0), F(0), -F("9.81") * s)
    return Chain("spatial_slider_crank", gravity, links, (cut,), (), (crank,), forces, assemble=True)


def _frame(x: Any, z: Any) -> Any:
    x = x / np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])


def _theta(parent: Any, child: Any, psi: Any, alpha: Any) -> float:
    from .table import screw_x, screw_z

    before = parent @ (screw_z(float(psi), 0) @ screw_x(float(alpha), 0))[:3, :3]
    turn = before.T @ child
    assert abs(turn[2, 2] - 1) < 1e-12, turn
    return float(np.arctan2(turn[1, 0], turn[0, 0]))


def four_bar(motion: Motion | None = None, angle: float = 0.5) -> Chain:
    """A parallelogram in the plane of x and y: cranks of 1 m at x = 0 and x = 2, a coupler of 2 m."""
    turn = F(angle)
    links = (
        link("crank 1", BASE, row(theta=turn), 1, (F(1, 2), 0, 0), (0, 0, F(1, 12))),
        link("coupler", "crank 1", row(a=1, theta=-turn), 2, (1, 0, 0), (0, 0, F(2, 3))),
        link("crank 2", BASE, row(a=2, theta=turn), 1, (F(1, 2), 0, 0), (0, 0, F(1, 12))),
        link("pin", "crank 2", row(a=1, theta=-turn)),
    )
    cuts = (Cut("coupler's end", Frame("coupler", row(a=2)), Frame("pin", Row())),)
    return Chain("four_bar", (F(0), F(-10), F(0)), links, cuts, (), (Independent("crank 1", motion),), assemble=True)


def three_cranks(misfit: F = F(0)) -> Chain:
    """The parallelogram with a third crank at x = 1, which is one too many; it may stand too far away."""
    chain = four_bar(angle=0.7)
    turn = F(0.7)
    more = (
        link("crank 3", BASE, row(a=1 + misfit, theta=turn), 1, (F(1, 2), 0, 0), (0, 0, F(1, 12))),
        link("pin 3", "crank 3", row(a=1, theta=-turn)),
    )
    cut = Cut("coupler's middle", Frame("coupler", row(a=1)), Frame("pin 3", Row()))
    return replace(chain, links=chain.links + more, cuts=(*chain.cuts, cut))
