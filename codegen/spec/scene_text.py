"""A scene as the text of a scene file (TOML), the same for the same scene.

Finite decimals are written in full up to 30 digits, other numbers with 20 digits.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from decimal import Context, Decimal
from fractions import Fraction

from codegen.errors import Mistake, SpecificationError
from codegen.spec.joint_text import joint_entries
from codegen.spec.scene import ZERO_VECTOR, Body, Coordinate, Drive, Force, Joint, Limit, Scene, Wanted

_LONGEST = Context(prec=30)
_ROUNDED = Context(prec=20)

_LOADS = ("torque", "stiffness", "damping", "rest", "drive", "limit")


def write_scene(scene: Scene) -> str:
    """Write a scene.

    Args:
        scene: any scene.

    Returns:
        The text of a scene file.

    Raises:
        SpecificationError: something acts on a coordinate of a joint whose directions a scene file cannot give.
    """
    joints: list[str] = []
    mistakes: list[Mistake] = []
    for joint in scene.joints:
        try:
            joints.append(_table("[[joint]]", _joint(joint, scene)))
        except SpecificationError as error:
            mistakes += error.mistakes
    if mistakes:
        raise SpecificationError(mistakes)
    tables = [_table("", _head(scene)), *(_table("[[body]]", _body(body)) for body in scene.bodies), *joints]
    for spring in scene.springs:
        kept = {key: getattr(spring, key) for key in ("bodies", "points", "stiffness", "damping", "length")}
        tables.append(_table("[[spring]]", kept))
    tables += [_table("[[torque]]", {"body": torque.body, "vector": torque.vector}) for torque in scene.torques]
    tables += [_table("[[force]]", _force(force)) for force in scene.forces]
    if scene.wanted != Wanted():
        kept = {key: getattr(scene.wanted, key) for key in ("quantities", "rows", "derivative")}
        tables.append(_table("[output]", {key: value for key, value in kept.items() if value}))
    return "\n".join(tables)


def _head(scene: Scene) -> dict[str, object]:
    entries: dict[str, object] = {"name": scene.name, "gravity": scene.gravity}
    return entries if scene.motion == "spatial" else entries | {"motion": scene.motion}


def _body(body: Body) -> dict[str, object]:
    entries: dict[str, object] = {"name": body.name}
    if body.mass:
        diagonal = tuple(body.inertia[k][k] for k in range(3))
        is_diagonal = not any(body.inertia[i][k] for i in range(3) for k in range(3) if i != k)
        entries |= {"mass": body.mass, "inertia": diagonal if is_diagonal else body.inertia}
    entries |= {"position": body.position, "quaternion": body.quaternion}
    velocities = {"velocity": body.velocity, "angular_velocity": body.angular_velocity}
    return entries | {key: value for key, value in velocities.items() if value != ZERO_VECTOR}


def _joint(joint: Joint, scene: Scene) -> dict[str, object]:
    entries: dict[str, object] = {"name": joint.name, "type": joint.type, "bodies": joint.bodies}
    entries |= joint_entries(joint, scene)
    entries |= {"pitch": joint.pitch} if joint.pitch else {}
    entries |= {"form": joint.form} if joint.form != "auto" else {}
    for key in _LOADS:
        values = [getattr(coordinate, key) for coordinate in joint.coordinates]
        if any(value != getattr(Coordinate(), key) for value in values):
            shown = [_load(value) for value in values]
            entries[key] = shown if len(shown) > 1 else shown[0]
    return entries


def _force(force: Force) -> dict[str, object]:
    entries: dict[str, object] = {"body": force.body, "vector": force.vector}
    return entries if force.point == ZERO_VECTOR else entries | {"point": force.point}


def _load(value: Fraction | Drive | Limit | None) -> object:
    match value:
        case None:
            return {}
        case Drive():
            sine = {key: getattr(value, key) for key in ("amplitude", "frequency", "phase")}
            given = {key: part for key, part in sine.items() if part}
            return {"position": value.position, "speed": value.speed, **given}
        case Limit():
            ends = {"lower": value.lower, "upper": value.upper}
            kept: dict[str, object] = {key: end for key, end in ends.items() if end is not None}
            return kept | {"stiffness": value.stiffness, "damping": value.damping}
    return value


def _table(head: str, entries: Mapping[str, object]) -> str:
    lines = [head] if head else []
    return "\n".join([*lines, *(f"{key} = {_value(value)}" for key, value in entries.items()), ""])


def _value(value: object) -> str:
    match value:
        case str():
            return _text(value)
        case Fraction():
            return _number(value)
        case Mapping():
            inside = ", ".join(f"{key} = {_value(item)}" for key, item in value.items())
            return f"{{ {inside} }}" if inside else "{}"
        case Iterable():
            return f"[{', '.join(map(_value, value))}]"
    raise TypeError(value)


def _number(value: Fraction) -> str:
    """A TOML float: the number itself if it is a finite decimal that is not too long."""
    numerator, denominator = Decimal(value.numerator), Decimal(value.denominator)
    decimal = _LONGEST.divide(numerator, denominator)
    if Fraction(decimal) != value:
        decimal = _ROUNDED.divide(numerator, denominator)
    text = str(decimal.normalize(_LONGEST)) if decimal else "0.0"
    if "E" not in text:
        return text if "." in text else f"{text}.0"
    plain = f"{decimal:f}"
    if len(plain) <= _LONGEST.prec:
        return plain if "." in plain else f"{plain}.0"
    return text.replace("E+", "e").replace("E", "e")


def _text(text: str) -> str:
    """A basic string; what does not print is escaped."""
    return f'"{"".join(_signs(text))}"'


def _signs(text: str) -> Iterator[str]:
    for sign in text:
        if sign in '"\\':
            yield f"\\{sign}"
        elif sign.isprintable():
            yield sign
        else:
            yield json.dumps(sign)[1:-1] if ord(sign) < 0x20 else f"\\U{ord(sign):08x}"
