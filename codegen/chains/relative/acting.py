"""Springs, torques and forces of a scene as those of a chain: end effectors where they act."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from codegen.chains.relative.pose import Pose, row_of
from codegen.spec.chain import Effector, Frame
from codegen.spec.chain_forces import Spring, WorldForce
from codegen.spec.placement import IDENTITY
from codegen.spec.scene import ZERO_VECTOR, Scene


@dataclass(frozen=True, slots=True)
class Acting:
    """What acts on bodies, as a chain has it."""

    effectors: tuple[Effector, ...]
    springs: tuple[Spring, ...]
    world_forces: tuple[WorldForce, ...]


def acting(scene: Scene, places: Mapping[str, tuple[str, Pose]]) -> Acting:
    """Hang effectors at the ends of springs, on bodies with torques and at the points of forces.

    Args:
        scene: the mechanism.
        places: name of a body, or of the ground -> link that it is on, and its pose there.
    """
    effectors, springs, forces = [], [], []
    for number, spring in enumerate(scene.springs, 1):
        names = [f"spring {number} on {body}" for body in spring.bodies]
        for name, body, point in zip(names, spring.bodies, spring.points, strict=True):
            effectors.append(_effector(name, places[body], Pose(IDENTITY, point)))
        springs.append(Spring((names[0], names[1]), spring.stiffness, spring.damping, spring.length))
    for number, torque in enumerate(scene.torques, 1):
        name = f"torque {number} on {torque.body}"
        effectors.append(_effector(name, places[torque.body], Pose()))
        forces.append(WorldForce(name, ZERO_VECTOR, torque.vector))
    for number, force in enumerate(scene.forces, 1):
        name = f"force {number} on {force.body}"
        effectors.append(_effector(name, places[force.body], Pose(IDENTITY, force.point)))
        forces.append(WorldForce(name, force.vector, ZERO_VECTOR))
    return Acting(tuple(effectors), tuple(springs), tuple(forces))


def _effector(name: str, place: tuple[str, Pose], own: Pose) -> Effector:
    link, body = place
    return Effector(name, Frame(link, row_of(body @ own)), ZERO_VECTOR, ZERO_VECTOR)
