"""The spanning tree of a scene: joints that carry bodies, in order from the ground, and joints that close loops."""

from __future__ import annotations

from dataclasses import dataclass

from codegen.spec.scene import GROUND, Joint, Scene


@dataclass(frozen=True, slots=True)
class Branch:
    """A body on the body that carries it.

    Attributes:
        body: its name.
        carrier: name of the body nearer the ground.
        joint: between them; None for a body that nothing connects to the ground: it is free.
    """

    body: str
    carrier: str
    joint: Joint | None

    @property
    def is_reversed(self) -> bool:
        """Whether the joint is gone through from its second body to its first."""
        return self.joint is not None and self.joint.bodies[0] == self.body


@dataclass(frozen=True, slots=True)
class Spanning:
    """A spanning tree.

    Attributes:
        branches: carriers first.
        loops: joints that close loops.
    """

    branches: tuple[Branch, ...]
    loops: tuple[Joint, ...]


def spanning(scene: Scene) -> Spanning:
    """Choose the joints of the tree: every body is as few joints from the ground as it can be.

    Every loop costs six rows whichever of its joints is cut, and the coordinates of all joints are there in any tree;
    short paths make short sums.
    """
    found: list[Branch] = []
    reached = {GROUND}
    waiting = list(scene.joints)
    while len(found) < len(scene.bodies):
        grown = _next(waiting, reached)
        if not grown:
            alone = next(body.name for body in scene.bodies if body.name not in reached)
            grown = [Branch(alone, GROUND, None)]
        found += grown
        reached |= {branch.body for branch in grown}
        used = {id(branch.joint) for branch in found}
        waiting = [joint for joint in waiting if id(joint) not in used]
    return Spanning(tuple(found), tuple(waiting))


def _next(joints: list[Joint], reached: set[str]) -> list[Branch]:
    """The bodies that are one joint from those reached, each by the first joint of the file."""
    found: dict[str, Branch] = {}
    for joint in joints:
        inside = [name for name in joint.bodies if name in reached]
        if len(inside) == 1:
            (carrier,) = inside
            body = joint.bodies[1] if joint.bodies[0] == carrier else joint.bodies[0]
            found.setdefault(body, Branch(body, carrier, joint))
    return list(found.values())
