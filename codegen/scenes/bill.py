"""What each simplification of a scene saves, in operations."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction

from codegen import build
from codegen.mechanics.assembly import Assembly
from codegen.scenes.forms import alone, constraint_quantities
from codegen.scenes.programs import program
from codegen.spec.placement import IDENTITY
from codegen.spec.request import Variant
from codegen.spec.scene import GROUND, ZERO_VECTOR, Body, Joint, Scene
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


def bill(assembly: Assembly, undropped: Assembly, operations: int) -> tuple[Item, ...]:
    """Count a scene before and after each simplification.

    Args:
        assembly: the scene as it is emitted.
        undropped: the scene with its redundant rows.
        operations: of the scene as it is emitted.
    """
    spatial = replace(assembly.scene, motion="spatial")
    names = constraint_quantities(assembly.scene)
    items = [
        Item("the library's routine of each joint", _each(spatial, assembly.forms, _in_library)),
        Item("geometry folded as constants", _each(spatial, assembly.forms, _folded)),
        Item("columns of the ground left out", _each(spatial, assembly.forms, _grounded)),
    ]
    together = Assembly(spatial, assembly.forms)
    if len(assembly.scene.joints) > 1:
        items.append(Item("joints evaluated together", count(program(together, names)).total))
    if assembly.scene.motion == "planar":
        items.append(Item("motion in the plane", count(program(undropped, names)).total))
    if undropped.dropped != assembly.dropped:
        items.append(Item("redundant rows left out", operations))
    return tuple(items)


_Counted = Callable[[Scene, Joint, Variant], int]


def _each(scene: Scene, forms: Mapping[str, Variant], counted: _Counted) -> int:
    known: dict[tuple[object, ...], int] = {}
    return sum(_once(scene, joint, forms[joint.name], counted, known) for joint in scene.joints)


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
