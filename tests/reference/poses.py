"""Random poses with general frames: consistent (phi = 0) or not, tangent velocities, multipliers; all seeded.

Inputs are dictionaries with the argument names of the routines: r_i [3] m, A_i [3x3], r_j, A_j, alpha [n]
(parametric), geometry [24, screw 27], velocity [12 + n], lambda [m].  All attitudes are proper rotations to
rounding.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .constraints import Pose, alpha_size, pair, phi, unpack_geometry
from .derivatives import pose_of, substitute, tensors
from .rotations import Rx, Rz, random_rotation
from .scalars import cast

Inputs = dict[str, NDArray[np.float64]]
LARGEST_ANGLE = 3.0  # rad: away from the branch cut of the screw angle
LARGEST_PITCH_ANGLE = 1.2  # rad: rot3 loses a coordinate at a2 = +-pi/2


def random_geometry(joint: str, rng: np.random.Generator) -> NDArray[np.float64]:
    """geometry [24], screw [27]: s_i, C_i, s_j, C_j (C column-major), pitch m/rad, theta_0 rad, turns."""
    frames = [np.concatenate([rng.normal(scale=0.5, size=3), random_rotation(rng).ravel(order="F")]) for _ in range(2)]
    screw = [rng.uniform(0.05, 0.3), rng.uniform(-1.0, 1.0), float(rng.integers(-2, 3))]
    return np.concatenate([*frames, screw if joint == "screw" else []])


def random_alpha(joint: str, rows: str | None, rng: np.random.Generator) -> NDArray[np.float64]:
    """Joint coordinates [n]: translations in m, then angles in rad or (quaternion) unit Euler parameters."""
    size = alpha_size(joint, "parametric", rows)
    trn = 0 if joint == "screw" else pair(joint)[0]
    if rows == "quaternion":
        e = rng.normal(size=4)
        return np.concatenate([rng.normal(size=trn), e / np.linalg.norm(e)])
    angles = rng.uniform(-LARGEST_ANGLE, LARGEST_ANGLE, size=size - trn)
    if pair(joint)[1] == 3:
        angles[1] = rng.uniform(-LARGEST_PITCH_ANGLE, LARGEST_PITCH_ANGLE)
    return np.concatenate([rng.normal(size=trn), angles])


def consistent_pose(
    joint: str, form: str, rng: np.random.Generator, rows: str | None = None, alpha: Any = None
) -> Inputs:
    """Pose and geometry with phi = 0.  `alpha`, if given, is taken as it is (also in the conventional form).

    The two forms of the universal joint differ: the cross axes are h_i and h_j in the conventional form, h_i
    and f_j in the parametric one (H = Rz(a1) Rx(a2)).
    """
    packed = random_geometry(joint, rng)
    geometry = unpack_geometry(packed)
    rows = rows if form == "parametric" else None
    alpha = random_alpha(joint, rows, rng) if alpha is None else np.asarray(alpha, dtype=float)
    start = Pose(rng.normal(size=3), random_rotation(rng), np.zeros(3), np.eye(3), alpha)
    if form == "conventional" and joint == "universal":
        turned = geometry.C_i @ Rz(alpha[0]) @ Rx(np.pi / 2) @ Rz(alpha[1]) @ geometry.C_j.T
        A_j = start.A_i @ turned
        r_j = start.r_i + start.A_i @ geometry.s_i - A_j @ geometry.s_j
        pose = Pose(start.r_i, start.A_i, r_j, A_j, alpha)
    else:
        pose = substitute(joint, rows, start, geometry)
    inputs = {"r_i": pose.r_i, "A_i": pose.A_i, "r_j": pose.r_j, "A_j": pose.A_j, "geometry": packed}
    return inputs | ({"alpha": alpha} if form == "parametric" else {})


def inconsistent_pose(joint: str, form: str, rng: np.random.Generator, rows: str | None = None) -> Inputs:
    """Pose off the manifold: independent rotations, positions, coordinates (Euler parameters off e.e = 1)."""
    geometry = random_geometry(joint, rng)
    while True:
        A_i, A_j = random_rotation(rng), random_rotation(rng)
        inputs = {
            "r_i": rng.normal(size=3),
            "A_i": A_i,
            "r_j": rng.normal(size=3),
            "A_j": A_j,
            "geometry": geometry,
        }
        if joint != "screw" or _screw_angle_is_clear(inputs):
            break
    if form == "parametric":
        alpha = random_alpha(joint, rows, rng)
        if rows == "quaternion":
            alpha[-4:] *= rng.uniform(0.8, 1.2)
        inputs["alpha"] = alpha
    return inputs


def _screw_angle_is_clear(inputs: Mapping[str, NDArray[np.float64]]) -> bool:
    """atan2(g_i.f_j, f_i.f_j) well defined and away from its branch cut."""
    geometry = unpack_geometry(inputs["geometry"])
    X = (inputs["A_i"] @ geometry.C_i).T @ (inputs["A_j"] @ geometry.C_j)
    return bool(np.hypot(X[0, 0], X[1, 0]) > 0.5 and (X[0, 0] > 0 or abs(X[1, 0]) > 0.1))


def tangent_velocity(phi_q: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.float64]:
    """Random velocity [n] with phi_q velocity = 0: projection on the null space of phi_q (SVD)."""
    _, sigma, right = np.linalg.svd(phi_q)
    null = right[int(np.sum(sigma > 1e-10 * sigma[0])) :]
    return np.asarray(null.T @ (null @ rng.normal(size=phi_q.shape[1])))


def sample(
    joint: str,
    form: str,
    seed: int,
    *,
    rows: str | None = None,
    variation: str = "body",
    consistent: bool = True,
    derivative: str = "exact",
) -> Inputs:
    """All inputs of a routine: pose, geometry, a velocity tangent in the given variation, lambda [m]."""
    rng = np.random.default_rng(seed)
    draw = consistent_pose if consistent else inconsistent_pose
    inputs = draw(joint, form, rng, rows)
    pose, geometry = pose_of(inputs), unpack_geometry(inputs["geometry"])
    first, _ = tensors(joint, form, rows, pose, geometry, variation=variation, derivative=derivative)
    return inputs | {"velocity": tangent_velocity(first, rng), "lambda": rng.normal(size=len(first))}


def residual(joint: str, form: str, inputs: Mapping[str, Any], rows: str | None = None) -> NDArray[np.float64]:
    """phi [m] of inputs as floats."""
    values = phi(joint, form, rows, pose_of(inputs), unpack_geometry(inputs["geometry"]))
    return np.asarray(values, dtype=float)


def convert(inputs: Mapping[str, Any], like: Any) -> dict[str, Any]:
    """Inputs with every number converted exactly to the number type of `like`, e.g. flint.arb(0)."""
    return {name: cast(value, like) for name, value in inputs.items()}
