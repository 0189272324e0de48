"""What each simplification of a scene saves, in operations."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction

from codegen import build
from codegen.mechanics.assembly import Assembly
from codegen.mechanics.plan import parts_of
from codegen.scenes.forms import alone, constraint_quantities
from codegen.scenes.programs import program
from codegen.spec.placement import IDENTITY
from codegen.spec.request import Variant
from codegen.spec.scene import GROUND, ZERO_VECTOR, Body, Joint, Scene
from codegen.spec.sections import attachments, likeness
from flopcount.count import count


@dataclass(frozen=True, slots=True)
class Item:
    """A line of the bill.

    Attributes:
        words: what was done.
        operations: of all constraint quantities at once, after it.
    """

    words: str
    operations: int


def bill(assembly: Assembly, undropped: Assembly, operations: int, is_looped: bool = False) -> tuple[Item, ...]:
    """Count a scene before and after each simplification.

    Args:
        assembly: the scene as it is emitted.
        undropped: the scene with its redundant rows.
        operations: of the scene as it is emitted.
        is_looped: whether it is emitted as loops.
    """
    spatial = replace(assembly, scene=replace(assembly.scene, motion="spatial"), dropped=frozenset())
    names = constraint_quantities(assembly.scene)
    steps: list[tuple[str, int]] = [
        ("the library's routine of each joint", _sum(spatial, _each(_in_library))),
        ("geometry folded as constants", _sum(spatial, _each(_folded))),
        ("columns of the ground left out", _sum(spatial, _each(_grounded))),
    ]

    def together(part: Assembly) -> int:
        return count(program(part, names)).total

    if len(assembly.scene.joints) > 1:
        steps.append(("joints evaluated together", _sum(spatial, together)))
    if assembly.scene.motion == "planar":
        steps.append(("motion in the plane", _sum(undropped, together)))
    if undropped.dropped != assembly.dropped:
        steps.append(("redundant rows left out", _sum(assembly, together) if is_looped else operations))
    if is_looped:
        steps.append(("equal parts run in loops", operations))
    return tuple(Item(*step) for step in steps)


def _sum(assembly: Assembly, counted: Callable[[Assembly], int]) -> int:
    """Count the sections of a scene; those that differ in numbers only are counted once."""
    known: dict[object, int] = {}
    total = 0
    for part in parts_of(assembly):
        key = likeness(part.scene), part.dropped, _special(part.scene)
        if key not in known:
            known[key] = counted(part)
        total += known[key]
    return total


def _special(scene: Scene) -> object:
    """The numbers that save operations."""
    numbers = (x for pair in attachments(scene) for point in pair for x in point)
    return tuple(x if x in (-1, 0, 1) else None for x in numbers)


_Counted = Callable[[Scene, Joint, Variant], int]


def _each(counted: _Counted) -> Callable[[Assembly], int]:
    """Count joint by joint."""
    known: dict[tuple[object, ...], int] = {}

    def summed(part: Assembly) -> int:
        scene, forms = part.scene, part.forms
        return sum(_once(scene, joint, forms[joint.name], counted, known) for joint in scene.joints)

    return summed


def _once(scene: Scene, joint: Joint, variant: Variant, counted: _Counted, known: dict[tuple[object, ...], int]) -> int:
    """Count a joint; equal ones once."""
    sides = tuple(name == GROUND for name in joint.bodies)
    key = (variant, joint.marker_i, joint.marker_j, joint.pitch, sides)
    if key not in known:
        known[key] = counted(scene, joint, variant)
    return known[key]


def _in_library(scene: Scene, joint: Joint, variant: Variant) -> int:
    return count(build.model(variant).program(constraint_quantities(scene))).total


def _folded(scene: Scene, joint: Joint, variant: Variant) -> int:
    """The joint between two bodies that move, the ground being one of them."""
    moving = Body("the ground", Fraction(1), IDENTITY, ZERO_VECTOR, (Fraction(1), *ZERO_VECTOR))
    i, j = (moving.name if name == GROUND else name for name in joint.bodies)
    loose = replace(joint, bodies=(i, j))
    return _grounded(replace(scene, bodies=(*scene.bodies, moving)), loose, variant)


def _grounded(scene: Scene, joint: Joint, variant: Variant) -> int:
    return count(program(alone(scene, joint, variant), constraint_quantities(scene))).total
