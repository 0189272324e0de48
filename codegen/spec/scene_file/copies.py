"""The same mechanism several times, side by side."""

from __future__ import annotations

from dataclasses import replace

from codegen.spec.scene import GROUND, Body, Force, Joint, Marker, Scene, Spring, Torque, Vector


def copied(scene: Scene, count: int, offset: Vector) -> Scene:
    """Repeat all bodies, joints, springs, torques and forces of a scene.

    Copy k, from 0 on, is displaced by ``k offset`` [3] m, world, together with its points on the ground; its names end
    in ``_1`` for the first copy and so on. One copy is the scene itself.
    """
    if count == 1:
        return scene
    copies = [_Copy(k, offset) for k in range(count)]
    return replace(
        scene,
        bodies=tuple(copy.body(body) for copy in copies for body in scene.bodies),
        joints=tuple(copy.joint(joint) for copy in copies for joint in scene.joints),
        springs=tuple(copy.spring(spring) for copy in copies for spring in scene.springs),
        torques=tuple(copy.torque(torque) for copy in copies for torque in scene.torques),
        forces=tuple(copy.force(force) for copy in copies for force in scene.forces),
    )


class _Copy:
    """One of the copies."""

    def __init__(self, k: int, offset: Vector) -> None:
        self._k = k
        self._shift = tuple(k * x for x in offset)

    def body(self, body: Body) -> Body:
        return replace(body, name=self._name(body.name), position=self._moved(body.position))

    def joint(self, joint: Joint) -> Joint:
        i, j = joint.bodies
        marker_i, marker_j = self._marker(joint.marker_i, i), self._marker(joint.marker_j, j)
        name = self._numbered(joint.name)
        return replace(joint, name=name, bodies=(self._name(i), self._name(j)), marker_i=marker_i, marker_j=marker_j)

    def spring(self, spring: Spring) -> Spring:
        (i, j), (a, b) = spring.bodies, spring.points
        points = (self._moved(a) if i == GROUND else a, self._moved(b) if j == GROUND else b)
        return replace(spring, bodies=(self._name(i), self._name(j)), points=points)

    def torque(self, torque: Torque) -> Torque:
        return replace(torque, body=self._name(torque.body))

    def force(self, force: Force) -> Force:
        return replace(force, body=self._name(force.body))

    def _name(self, body: str) -> str:
        return GROUND if body == GROUND else self._numbered(body)

    def _numbered(self, name: str) -> str:
        return f"{name}_{self._k + 1}"

    def _marker(self, marker: Marker, body: str) -> Marker:
        return replace(marker, point=self._moved(marker.point)) if body == GROUND else marker

    def _moved(self, point: Vector) -> Vector:
        x, y, z = (a + b for a, b in zip(point, self._shift, strict=True))
        return x, y, z
