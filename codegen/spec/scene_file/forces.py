"""Springs between points, and torques and forces on bodies of a scene file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from codegen.errors import Mistake
from codegen.spec.placement import difference, times
from codegen.spec.scene import GROUND, ZERO_VECTOR, Force, Spring, Torque, Vector
from codegen.spec.scene_file.bodies import GROUND_POSE, Pose
from codegen.spec.scene_file.entries import ForceEntry, SpringEntry, TorqueEntry
from codegen.spec.scene_file.names import pair_mistakes, unknown_body_mistakes
from codegen.spec.scene_file.text import shown


def spring_mistakes(entry: SpringEntry, bodies: Mapping[str, Pose | None]) -> Iterator[Mistake]:
    """Check one spring; the bodies are those of the scene without the ground, None where a pose is wrong."""
    units = {"stiffness": "N/m", "damping": "N s/m", "length": "m"}
    for key, unit in units.items():
        value = getattr(entry, key)
        if value < 0:
            yield Mistake(f"{entry.place}: {key}", f"is {shown(value)} {unit}", f"give 0 {unit} or more")
    if entry.bodies is None:
        return
    yield from pair_mistakes(entry.bodies, f"{entry.place}: bodies", bodies)
    i, j = (GROUND_POSE if name == GROUND else bodies.get(name) for name in entry.bodies)
    if entry.points is None or i is None or j is None or entry.bodies[0] == entry.bodies[1]:
        return
    a, b = (_world(point, pose) for point, pose in zip(entry.points, (i, j), strict=True))
    if not any(difference(a, b)) and (entry.length > 0 or entry.damping > 0):
        what = "its ends coincide at t = 0, where its force has no direction"
        yield Mistake(f"{entry.place}: points", what, "move an end, or give length = 0 m and damping = 0 N s/m")


def load_mistakes(entry: TorqueEntry | ForceEntry, bodies: Mapping[str, Pose | None]) -> Iterator[Mistake]:
    """Check one torque or force."""
    if entry.body == GROUND:
        kind = "torque" if isinstance(entry, TorqueEntry) else "force"
        yield Mistake(f"{entry.place}: body", f"a {kind} on the ground moves nothing", "name a body")
    elif entry.body is not None:
        yield from unknown_body_mistakes(entry.body, f"{entry.place}: body", bodies)


def make_spring(entry: SpringEntry) -> Spring:
    """Make a spring of an entry without mistakes."""
    points = entry.points or (ZERO_VECTOR, ZERO_VECTOR)
    return Spring(entry.bodies or ("", ""), points, entry.stiffness, entry.damping, entry.length)


def make_torque(entry: TorqueEntry) -> Torque:
    """Make a torque of an entry without mistakes."""
    return Torque(entry.body or "", entry.vector or ZERO_VECTOR)


def make_force(entry: ForceEntry) -> Force:
    """Make a force of an entry without mistakes."""
    return Force(entry.body or "", entry.vector or ZERO_VECTOR, entry.point)


def _world(point: Vector, pose: Pose) -> Vector:
    x, y, z = (a + b for a, b in zip(pose.position, times(pose.attitude, point), strict=True))
    return x, y, z
