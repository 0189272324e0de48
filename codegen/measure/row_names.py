"""Names and units of the rows of a joint in a scene, and units of its coordinates."""

from __future__ import annotations

from codegen.measure.constraints import Row
from codegen.spec.joints import Dot1, Dot2, JointType, Spherical

_POINT = tuple(Row(f"{axis} of the point", "m") for axis in "xyz")
_POINT_IN_BODY = tuple(Row(f"{axis} of the point in axes of body i", "m") for axis in "xyz")
_REGULAR = ("g* . h_j", "h* . f_j", "f* . g_j")
_TABLE4 = (
    ("g_i . h_j", "h_i . f_j", "f_i . g_j"),
    ("f_i . h_j", "g_i . h_j", "f_i . f_j"),
    ("h_i . f_j", "f_i . f_j", "h_i . h_j"),
    ("f_i . f_j", "h_i . f_j", "h_i . h_j"),
)


def conventional_rows(joint: JointType) -> tuple[Row, ...]:
    """Name the rows of the conventional form; the axes of a universal joint's cross are h_i and f_j, as in a scene."""
    rows: list[Row] = []
    for constraint in joint.conventional:
        if isinstance(constraint, Spherical):
            rows += _POINT
        elif isinstance(constraint, Dot1):
            axis_j = "f" if joint.name == "universal" else constraint.axis_j
            rows.append(Row(f"{constraint.axis_i}_i . {axis_j}_j", "1"))
        elif isinstance(constraint, Dot2):
            rows.append(Row(f"{constraint.axis_i}_i . d_ij", "m"))
        else:
            rows.append(Row("advance along h_i", "m"))
    return tuple(rows)


def parametric_rows(joint: JointType, rows: str = "regular", point: str = "body") -> tuple[Row, ...]:
    """Name the rows of the parametric form; ``rows`` and ``point`` as in `codegen.spec.request.Variant`."""
    if rows == "table4":
        names: tuple[str, ...] = _TABLE4[joint.rotations]
    else:
        names = (*_REGULAR, "e . e - 1") if rows == "quaternion" else _REGULAR
    is_in_world = point == "world" and not joint.translations
    return (*(_POINT if is_in_world else _POINT_IN_BODY), *(Row(name, "1") for name in names))


def coordinate_units(joint: JointType, rows: str = "regular") -> tuple[str, ...]:
    """Give the units of the coordinates in the parametric form: translations in m, then rotations in rad."""
    if joint.is_screw:
        return ("rad",)
    return ("m",) * joint.translations + ("rad",) * (4 if rows == "quaternion" else joint.rotations)
