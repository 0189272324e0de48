"""Which form each joint of a scene takes: the one asked for, the one its loads need, or the cheaper one."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace

from codegen.errors import Mistake, SpecificationError
from codegen.mechanics.assembly import Assembly
from codegen.scenes.programs import Lowered, estimate, lower_ahead, program, without_zero_rows
from codegen.spec.request import Variant
from codegen.spec.scene import GROUND, Joint, Scene
from codegen.spec.sections import alike
from flopcount.count import count
from flopcount.counts import Counts

TRIGONOMETRY = 20
"""Price of a sine and cosine of one angle, in additions: about what the C library takes on current processors."""

FORMS = ("conventional", "parametric")
"""Those that are weighed."""

_CONSTRAINTS = ("phi", "phi_q", "phi_q_t_lambda_q", "gamma", "phi_q_v", "phi_q_t_lambda")


@dataclass(frozen=True, slots=True)
class Choice:
    """The form of a joint and why it has it.

    Attributes:
        variant: form, rows and derivative.
        why: in words.
        prices: form -> price of the joint alone, where both were weighed.
    """

    variant: Variant
    why: str
    prices: Mapping[str, int]


def is_relative(scene: Scene, form: str | None) -> bool:
    """Whether a scene is to be taken by relative coordinates, as a chain.

    Args:
        scene: the mechanism; relative coordinates are of all joints together, so one joint that asks is enough.
        form: for all joints, in the place of what the scene says.

    Raises:
        SpecificationError: other joints ask for another form.
    """
    if form is not None:
        return form == "relative"
    asking = [joint.name for joint in scene.joints if joint.form == "relative"]
    what = f'joint "{asking[0]}" asks for relative coordinates, which all joints have or none' if asking else ""
    mistakes = [
        Mistake(f'joint "{joint.name}": form', f'is "{joint.form}", and {what}', "use relative or auto")
        for joint in scene.joints
        if asking and joint.form in ("conventional", "parametric")
    ]
    if mistakes:
        raise SpecificationError(mistakes)
    return bool(asking)


def choose_forms(scene: Scene, form: str | None = None) -> dict[str, Choice]:
    """Choose the form of every joint; sections of the scene that are alike have the same forms.

    Args:
        scene: the mechanism.
        form: for all joints that may have it, in the place of what the scene says.

    Raises:
        SpecificationError: a joint is to have relative coordinates: routines of bodies have none.
    """
    remedy = "use auto, conventional or parametric"
    mistakes = [
        Mistake(f'joint "{joint.name}": form', "the routines of bodies have no relative coordinates", remedy)
        for joint in scene.joints
        if (form or joint.form) == "relative"
    ]
    if mistakes:
        raise SpecificationError(mistakes)
    known: dict[tuple[object, ...], dict[str, int]] = {}
    found: dict[str, Choice] = {}
    for sections in alike(scene):
        last = sections[-1].scene(scene)  # the first of several copies has no offset
        lower_ahead(_to_weigh(last, form, known))
        choices = [_choice(last, joint, form, known) for joint in last.joints]
        for section in sections:
            joints = section.scene(scene).joints
            found |= {joint.name: choice for joint, choice in zip(joints, choices, strict=True)}
    return {joint.name: found[joint.name] for joint in scene.joints}


def _choice(scene: Scene, joint: Joint, form: str | None, known: dict[tuple[object, ...], dict[str, int]]) -> Choice:
    asked = joint.form if form is None else form
    if joint.needs_coordinates:
        return Choice(_variant(scene, joint, "parametric"), "something acts on its coordinates", {})
    if asked in FORMS:
        return Choice(_variant(scene, joint, asked), "asked for", {})
    prices = _prices(scene, joint, known)
    chosen = min(prices, key=lambda name: prices[name])
    words = " against ".join(f"{prices[name]} ({name})" for name in sorted(prices, key=lambda name: prices[name]))
    return Choice(_variant(scene, joint, chosen), f"cheaper: {words}", prices)


def _to_weigh(scene: Scene, form: str | None, known: Collection[tuple[object, ...]]) -> list[list[Lowered]]:
    """What the prices of the joints of a scene take, by type and form; equal joints once."""
    joints = {
        _likeness(joint): joint
        for joint in reversed(scene.joints)
        if not joint.needs_coordinates and (form or joint.form) not in FORMS and _likeness(joint) not in known
    }
    types = dict.fromkeys(joint.type for joint in joints.values())
    return [
        [_alone(scene, joint, form) for joint in joints.values() if joint.type == name]
        for form in reversed(FORMS)  # what takes longer first
        for name in types
    ]


def _variant(scene: Scene, joint: Joint, form: str) -> Variant:
    if form == "conventional":
        return Variant(joint.type, form, None)
    return Variant(joint.type, form, scene.wanted.rows, scene.wanted.derivative, point=scene.wanted.point)


def _prices(scene: Scene, joint: Joint, known: dict[tuple[object, ...], dict[str, int]]) -> dict[str, int]:
    """Price of a joint alone in both forms; equal joints are weighed once."""
    key = _likeness(joint)
    if key not in known:
        known[key] = {form: price(count(program(*_alone(scene, joint, form)))) for form in FORMS}
    return known[key]


def _likeness(joint: Joint) -> tuple[object, ...]:
    sides = tuple(name == GROUND for name in joint.bodies)
    return joint.type, joint.marker_i, joint.marker_j, joint.pitch, sides


def _alone(scene: Scene, joint: Joint, form: str) -> Lowered:
    return alone(scene, joint, _variant(scene, joint, form)), constraint_quantities(scene), estimate


def alone(scene: Scene, joint: Joint, variant: Variant) -> Assembly:
    """A joint of a scene with its two bodies and nothing else."""
    bodies = tuple(body for body in scene.bodies if body.name in joint.bodies)
    only = replace(scene, bodies=bodies, joints=(joint,), springs=(), torques=(), forces=())
    return without_zero_rows(Assembly(only, {joint.name: variant}))


def constraint_quantities(scene: Scene) -> tuple[str, ...]:
    """The quantities of the constraints that a scene asks for."""
    asked = tuple(name for name in _CONSTRAINTS if name in scene.wanted.quantities)
    return asked or _CONSTRAINTS[:3]


def price(counts: Counts) -> int:
    """Operations, with sines and cosines at their price."""
    return counts.total + (TRIGONOMETRY - 1) * counts.sincos
