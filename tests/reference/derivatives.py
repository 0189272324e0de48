"""Truth for phi_q, phi_q_t_lambda_q, gamma and products, from `constraints` alone by second-order numbers.

Variation vector (SPEC S1.0): (delta r_i, delta pi_i, delta r_j, delta pi_j, delta alpha) [n].
    variation "body":  delta A = A (delta pi)~, delta pi in body axes; delta r in world axes in the
                       conventional form, delta r' = A^T delta r in body axes in the parametric form.
    variation "world": delta A = (delta pi)~ A; delta pi and delta r in world axes, both forms.
Second derivatives apply the same variations twice: first the outer one, d( . )/dq_k, then the inner one,
column l of phi_q, at the pose moved by the outer one; hence phi_q_t_lambda_q[l, k] is not symmetric.  All
results come in the number type of the inputs (float, or flint.arb at the precision of `flint.ctx`).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from .constraints import (
    F,
    G,
    Geometry,
    H,
    Pose,
    pair,
    phi,
    phi_conventional,
    relative_position,
    relative_rotation,
    split_alpha,
    unpack_geometry,
)
from .rotations import skew
from .scalars import Array, Jet, Scalar, atan2, cast

R_I, PI_I, R_J, PI_J, ALPHA = slice(0, 3), slice(3, 6), slice(6, 9), slice(9, 12), slice(12, None)
EYE = np.eye(3, dtype=int)


def pose_of(inputs: Mapping[str, Any]) -> Pose:
    """Pose from inputs named r_i, A_i, r_j, A_j (matrices [3x3]) and, in the parametric form, alpha."""
    alpha = inputs.get("alpha", np.zeros(0))
    return Pose(inputs["r_i"], inputs["A_i"], inputs["r_j"], inputs["A_j"], alpha)


def infinitesimals(n: int, like: Scalar) -> tuple[Array, Array]:
    """Outer and inner unknowns, two arrays [n] of Jet with value 0."""
    unit, none = cast(np.eye(n), like), cast(np.zeros(n), like)
    zero, cross = cast(0.0, like)[()], cast(np.zeros((n, n)), like)
    outer, inner = np.empty(n, dtype=object), np.empty(n, dtype=object)
    for k in range(n):
        outer[k] = Jet(zero, unit[k], none, cross)
        inner[k] = Jet(zero, none, unit[k], cross)
    return outer, inner


def step(pose: Pose, delta: Array, form: str, variation: str) -> Pose:
    """Pose moved by one infinitesimal variation vector [n], to first order in it."""
    turn_i, turn_j = EYE + skew(delta[PI_I]), EYE + skew(delta[PI_J])
    if variation == "world":
        A_i, A_j = turn_i @ pose.A_i, turn_j @ pose.A_j
    elif variation == "body":
        A_i, A_j = pose.A_i @ turn_i, pose.A_j @ turn_j
    else:
        raise ValueError(f"unknown variation {variation!r}")
    dr_i, dr_j = delta[R_I], delta[R_J]
    if form == "parametric" and variation == "body":
        dr_i, dr_j = pose.A_i @ dr_i, pose.A_j @ dr_j
    return Pose(pose.r_i + dr_i, A_i, pose.r_j + dr_j, A_j, pose.alpha + delta[ALPHA])


def substitute(joint: str, rows: str | None, pose: Pose, geometry: Geometry) -> Pose:
    """Pose with body j where alpha wants it: A_ij = C_i H(alpha) C_j^T, d'_ij = d'(alpha)."""
    trn, rot = pair(joint)
    offsets, angles = split_alpha(joint, rows, pose.alpha, geometry)
    A_j = pose.A_i @ (geometry.C_i @ relative_rotation(rot, angles) @ geometry.C_j.T)
    d = relative_position(trn, offsets, geometry)
    r_j = pose.r_i + pose.A_i @ (geometry.s_i + d) - A_j @ geometry.s_j
    return Pose(pose.r_i, pose.A_i, r_j, A_j, pose.alpha)


def screw_theta(pose: Pose, geometry: Geometry) -> Scalar:
    """atan2(g_i.f_j, f_i.f_j), rad."""
    frame_i, frame_j = pose.A_i @ geometry.C_i, pose.A_j @ geometry.C_j
    return atan2(frame_i[:, G] @ frame_j[:, F], frame_i[:, F] @ frame_j[:, F])


def theta_on_manifold(pose: Pose, moved: Pose, geometry: Geometry, variation: str) -> Jet:
    """theta with the *stated* variation delta theta = h_i . (delta pi_j - delta pi_i) (world), as a Jet.

    `pose` is the base pose, `moved` the pose after the outer step; SPEC S1.1.
    """
    h = moved.A_i @ geometry.C_i[:, H]
    w_i, w_j = (h, h) if variation == "world" else (moved.A_i.T @ h, moved.A_j.T @ h)
    n = len(h[0].outer)
    first, cross = h[0].outer * 0, h[0].cross * 0
    for l_index, w in [*enumerate(-w_i, 3), *enumerate(w_j, 9)]:
        first[l_index] = w.value
        cross[:, l_index] = w.outer
    assert first.shape == (n,)
    return Jet(screw_theta(pose, geometry), first, first, cross)


def tensors(
    joint: str,
    form: str,
    rows: str | None,
    pose: Pose,
    geometry: Geometry,
    *,
    derivative: str = "exact",
    variation: str = "body",
    screw: str = "exact",
) -> tuple[Array, Array]:
    """phi_q [m, n] and its derivative phi_qq [m, n (outer k), n (inner l)] = d(phi_q[m, l])/dq_k.

    derivative "substituted" (parametric only): phi_q after A_ij = C_i H(alpha) C_j^T, d'_ij = d'(alpha), then
    derived; a function of alpha alone for variation "body", of alpha and A_i for "world".  For quaternion
    rows it is literal in H(e); compare at e.e = 1 only.  screw "manifold" (conventional screw only): delta
    theta as stated in SPEC S1.1 instead of the derivative of atan2; equal on the manifold in phi_q, different
    in phi_qq.
    """
    outer, inner = infinitesimals(12 + len(pose.alpha), pose.r_i[0])
    moved = step(pose, outer, form, variation)
    if derivative == "substituted":
        if form != "parametric":
            raise ValueError("substituted derivatives exist in the parametric form only")
        moved = substitute(joint, rows, moved, geometry)
    elif derivative != "exact":
        raise ValueError(f"unknown derivative {derivative!r}")
    varied = step(moved, inner, form, variation)
    if screw == "manifold" and form == "conventional" and joint == "screw":
        values = phi_conventional(joint, varied, geometry, theta_on_manifold(pose, moved, geometry, variation))
    else:
        values = phi(joint, form, rows, varied, geometry)
    return np.array([x.inner for x in values]), np.array([x.cross for x in values])


def transport(velocity: Array) -> Array:
    """Time derivative [n] of the velocity vector of variation "body", parametric, at zero acceleration.

    r' components: d(A^T rdot)/dt = -omega x (A^T rdot); all else 0.
    """
    rate = velocity * 0
    rate[R_I] = -(skew(velocity[PI_I]) @ velocity[R_I])
    rate[R_J] = -(skew(velocity[PI_J]) @ velocity[R_J])
    return rate


def gamma_from_tensors(first: Array, second: Array, velocity: Array, form: str, variation: str) -> Array:
    """gamma [m] = -(d(phi_q)/dt v + phi_q transport(v)), the right-hand side of phi_q a = gamma.

    a = (r_i'' in the axes of delta r, omega_i', r_j'', omega_j', alpha''), r'' the classical acceleration.
    """
    gamma = -((second @ velocity) @ velocity)
    if form == "parametric" and variation == "body":
        gamma = gamma - first @ transport(velocity)
    return gamma


def gamma_along_motion(
    joint: str,
    form: str,
    rows: str | None,
    pose: Pose,
    geometry: Geometry,
    velocity: Array,
    variation: str = "body",
) -> Array:
    """gamma [m], exact: minus the second time derivative of phi along r'' = 0, omega' = 0, alpha'' = 0.

    Independent of `tensors`: t = e + d with e^2 = d^2 = 0, so t^2 = 2 e d, and the e d part is the second
    derivative.
    """
    (e,), (d,) = infinitesimals(1, pose.r_i[0])
    t = e + d
    v_i, w_i, v_j, w_j = (velocity[part] for part in (R_I, PI_I, R_J, PI_J))
    if form == "parametric" and variation == "body":
        v_i, v_j = pose.A_i @ v_i, pose.A_j @ v_j
    turns = []
    for A, w in ((pose.A_i, w_i), (pose.A_j, w_j)):
        W = skew(w)
        turn = EYE + W * t + (W @ W) * (t * t / 2)
        turns.append(turn @ A if variation == "world" else A @ turn)
    moved = Pose(pose.r_i + v_i * t, turns[0], pose.r_j + v_j * t, turns[1], pose.alpha + velocity[ALPHA] * t)
    return np.array([-x.cross[0, 0] for x in phi(joint, form, rows, moved, geometry)])


def evaluate(
    joint: str,
    form: str,
    output: str,
    inputs: Mapping[str, Any],
    *,
    rows: str | None = None,
    derivative: str = "exact",
    variation: str = "body",
    screw: str = "exact",
) -> Array:
    """One output: phi [m], phi_q [m, n], phi_q_t_lambda_q [n, n], gamma, phi_q_v [m] or phi_q_t_lambda [n].

    inputs: r_i, A_i [3x3], r_j, A_j [3x3], alpha (parametric), geometry, velocity [n], lambda [m] as far as
    needed.  phi is always the exact residual; gamma of derivative "substituted" is built from the substituted
    phi_q.
    """
    pose, geometry = pose_of(inputs), unpack_geometry(inputs["geometry"])
    if output == "phi":
        return phi(joint, form, rows, pose, geometry)
    first, second = tensors(joint, form, rows, pose, geometry, derivative=derivative, variation=variation, screw=screw)
    if output == "phi_q":
        return first
    if output == "phi_q_t_lambda_q":
        return np.tensordot(inputs["lambda"], second, axes=(0, 0)).T
    if output == "gamma":
        return gamma_from_tensors(first, second, inputs["velocity"], form, variation)
    if output == "phi_q_v":
        return np.asarray(first @ inputs["velocity"])
    if output == "phi_q_t_lambda":
        return np.asarray(first.T @ inputs["lambda"])
    raise ValueError(f"unknown output {output!r}")


def evaluate_entry(entry: Mapping[str, Any], inputs: Mapping[str, Any], *, screw: str = "exact") -> dict[str, Array]:
    """Truth of every output of a manifest entry, dense, by name."""
    outputs = entry["outputs"] if entry["output"] == "all" else [entry["output"]]
    options = {"rows": entry["rows"], "derivative": entry["derivative"], "variation": entry["variation"]}
    return {name: evaluate(entry["joint"], entry["form"], name, inputs, screw=screw, **options) for name in outputs}
