"""phi of every joint in both forms, for any number type.  SPEC S1.1 (Table 1), S1.2 (Tables 3 to 5).

Lengths in m, angles in rad.  Frames: r world; A_i, A_j body to world; s_i, C_i in the axes of body i,
s_j, C_j in those of body j.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from .rotations import Rx, Ry, Rz, from_euler_parameters
from .scalars import Array, Scalar, atan2, cos, sin

F, G, H = 0, 1, 2  # columns of a joint frame C = [f g h]

# Rows of the conventional form: "d" = d_ij [3]; "f.h" = f_i . h_j; "f.d" = f_i . d_ij; "screw".
CONVENTIONAL: dict[str, tuple[str, ...]] = {
    "revolute": ("d", "f.h", "g.h"),
    "translational": ("f.h", "g.h", "f.g", "f.d", "g.d"),
    "cylindrical": ("f.d", "g.d", "f.h", "g.h"),
    "screw": ("f.d", "g.d", "f.h", "g.h", "screw"),
    "universal": ("d", "h.h"),
    "planar": ("f.h", "g.h", "h.d"),
    "ball": ("d",),
    "rigid": ("d", "f.h", "g.h", "f.g"),
}

# (k, l) of trn_k + rot_l.
PARAMETRIC: dict[str, tuple[int, int]] = {
    "revolute": (0, 1),
    "translational": (1, 0),
    "cylindrical": (1, 1),
    "screw": (1, 1),
    "universal": (0, 2),
    "planar": (2, 1),
    "ball": (0, 3),
    "rigid": (0, 0),
    "free": (3, 3),
}
ALL_PAIRS = tuple(f"trn{k}_rot{m}" for k in range(4) for m in range(4))
CATALOGUE_PAIRS = {
    f"trn{PARAMETRIC[joint][0]}_rot{PARAMETRIC[joint][1]}": joint for joint in CONVENTIONAL if joint != "screw"
}
"""Pairs whose parametric form is that of a joint of the catalogue."""
TRANSLATION_AXES = ((), (H,), (F, G), (F, G, H))


@dataclass(frozen=True, slots=True)
class Pose:
    """r_i, r_j [3] m world; A_i, A_j [3x3] body to world; alpha [n], empty in the conventional form."""

    r_i: Array
    A_i: Array
    r_j: Array
    A_j: Array
    alpha: Array


@dataclass(frozen=True, slots=True)
class Geometry:
    """s [3] m, C [3x3] on each body, body axes; screw: pitch (advance, m/rad), theta_0 rad, turns."""

    s_i: Array
    C_i: Array
    s_j: Array
    C_j: Array
    pitch: Scalar = 0.0
    theta_0: Scalar = 0.0
    turns: Scalar = 0.0


def unpack_geometry(geometry: Array) -> Geometry:
    """Geometry from s_i[3] C_i[9] s_j[3] C_j[9] (C column-major), screw: then pitch, theta_0, n."""
    C_i, C_j = geometry[3:12].reshape(3, 3).T, geometry[15:24].reshape(3, 3).T
    return Geometry(geometry[0:3], C_i, geometry[12:15], C_j, *geometry[24:27])


def pair(joint: str) -> tuple[int, int]:
    """(k, l) of trn_k + rot_l for a joint of the catalogue or for a name such as "trn2_rot3"."""
    match = re.fullmatch(r"trn([0-3])_?rot([0-3])", joint)
    return (int(match[1]), int(match[2])) if match else PARAMETRIC[joint]


def alpha_size(joint: str, form: str, rows: str | None = None) -> int:
    """Number of joint coordinates: conventional 0, screw 1, else k + l (quaternion k + 4)."""
    if form == "conventional":
        return 0
    trn, rot = pair(joint)
    if rows == "quaternion" and rot != 3:
        raise ValueError(f"{joint}: quaternion rows exist for rot3 only")
    return 1 if joint == "screw" else trn + (4 if rows == "quaternion" else rot)


def split_alpha(joint: str, rows: str | None, alpha: Array, geometry: Geometry) -> tuple[Array, Array]:
    """(translational [k], rotational [l or 4]) coordinates; screw: a1 = p (alpha + 2 pi n + theta_0)."""
    trn, _ = pair(joint)
    if joint != "screw":
        return alpha[:trn], alpha[trn:]
    advance = geometry.pitch * screw_angle(alpha[0], geometry)
    return np.array([advance], dtype=np.asarray(advance).dtype), alpha


def screw_angle(theta: Scalar, geometry: Geometry) -> Scalar:
    """theta + 2 pi n + theta_0, rad; pi in the number type of the geometry."""
    like = geometry.theta_0
    two_pi = 2 * type(like).pi() if hasattr(type(like), "pi") else 2 * np.pi
    return theta + two_pi * geometry.turns + geometry.theta_0


def relative_rotation(rot: int, angles: Array) -> Array:
    """H(alpha) of rot_l [3x3] (Table 3); four angles mean Euler parameters."""
    if len(angles) == 4:
        return from_euler_parameters(angles)
    if rot == 0:
        return np.eye(3, dtype=int)
    if rot == 1:
        return Rz(angles[0])
    if rot == 2:
        return Rz(angles[0]) @ Rx(angles[1])
    return Rz(angles[0]) @ Ry(angles[1]) @ Rx(angles[2])


def relative_position(trn: int, offsets: Array, geometry: Geometry) -> Array:
    """d'(alpha) [3] m of trn_k in the axes of body i (Table 3)."""
    d = geometry.s_i * 0
    for axis, offset in zip(TRANSLATION_AXES[trn], offsets, strict=True):
        d = d + geometry.C_i[:, axis] * offset
    return d


def phi_conventional(joint: str, pose: Pose, geometry: Geometry, theta: Scalar | None = None) -> Array:
    """Constraint values [m] of the conventional form, rows in the order of `CONVENTIONAL`.

    `theta` replaces atan2(g_i.f_j, f_i.f_j) of the screw row (see `derivatives`).
    """
    frame_i, frame_j = pose.A_i @ geometry.C_i, pose.A_j @ geometry.C_j
    d_ij = pose.r_j + pose.A_j @ geometry.s_j - pose.r_i - pose.A_i @ geometry.s_i
    values: list[Scalar] = []
    for row in CONVENTIONAL[joint]:
        if row == "d":
            values.extend(d_ij)
        elif row == "screw":
            if theta is None:
                theta = atan2(frame_i[:, G] @ frame_j[:, F], frame_i[:, F] @ frame_j[:, F])
            values.append(frame_i[:, H] @ d_ij - geometry.pitch * screw_angle(theta, geometry))
        else:
            left, right = frame_i[:, "fgh".index(row[0])], row[2]
            values.append(left @ (d_ij if right == "d" else frame_j[:, "fgh".index(right)]))
    return np.array(values)


def rotational_rows(rot: int, rows: str, angles: Array, C_i: Array, B_j: Array) -> list[Scalar]:
    """The three rows of rot_l (four for quaternion); B_j = A_ij C_j = [f_j g_j h_j] in the axes of body i."""
    if rows != "table4":
        star = C_i @ relative_rotation(rot, angles)
        values = [star[:, G] @ B_j[:, H], star[:, H] @ B_j[:, F], star[:, F] @ B_j[:, G]]
        return values if rows == "regular" else [*values, angles @ angles - 1]
    X = C_i.T @ B_j  # X[a, b] = a_i . b_j
    c, s = [cos(a) for a in angles], [sin(a) for a in angles]
    if rot == 0:
        return [X[G, H], X[H, F], X[F, G]]
    if rot == 1:
        return [X[F, H], X[G, H], X[F, F] - c[0]]
    if rot == 2:
        return [X[H, F], X[F, F] - c[0], X[H, H] - c[1]]
    return [X[F, F] - c[0] * c[1], X[H, F] + s[1], X[H, H] - c[1] * c[2]]


def phi_parametric(joint: str, rows: str, pose: Pose, geometry: Geometry) -> Array:
    """Constraint values [6, quaternion 7]: A_i^T d_ij - d'(alpha), then the rotational rows.

    rows: "regular", "table4" or (rot3 only) "quaternion".
    """
    trn, rot = pair(joint)
    if rows not in ("regular", "table4", "quaternion"):
        raise ValueError(f"unknown rows {rows!r}")
    offsets, angles = split_alpha(joint, rows, pose.alpha, geometry)
    d_ij = pose.r_j + pose.A_j @ geometry.s_j - pose.r_i - pose.A_i @ geometry.s_i
    translation = pose.A_i.T @ d_ij - relative_position(trn, offsets, geometry)
    B_j = pose.A_i.T @ (pose.A_j @ geometry.C_j)
    return np.array([*translation, *rotational_rows(rot, rows, angles, geometry.C_i, B_j)])


def phi(joint: str, form: str, rows: str | None, pose: Pose, geometry: Geometry) -> Array:
    """Constraint values [m] of either form; parametric rows default to "regular"."""
    if form == "conventional":
        return phi_conventional(joint, pose, geometry)
    return phi_parametric(joint, rows or "regular", pose, geometry)
