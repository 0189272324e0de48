"""Derivatives of a scene's constraints from the constraints alone, by second-order numbers on SO(3).

The bodies of the whole mechanism are moved by infinitesimals, first the outer, then the inner ones; nothing is
assembled from derivatives of joints. See `tests.reference.derivatives`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from codegen.mechanics.assembly import Assembly
from codegen.spec.markers import markers
from codegen.spec.scene import GROUND, Joint
from tests.reference.constraints import Geometry, Pose, phi
from tests.reference.derivatives import EYE, infinitesimals, substitute
from tests.reference.rotations import skew
from tests.reference.scalars import Array, cast

from .library import coordinates_of


@dataclass(frozen=True)
class Moving:
    """Bodies by name, with the ground; coordinates of all joints."""

    r: Mapping[str, Array]
    A: Mapping[str, Array]
    alpha: Array


def start(assembly: Assembly, inputs: Mapping[str, Any]) -> Moving:
    """The bodies where the inputs say."""
    like = inputs["r"][0]
    r, A = {GROUND: cast(np.zeros(3), like)}, {GROUND: cast(np.eye(3), like)}
    for k, body in enumerate(assembly.scene.bodies):
        r[body.name] = np.array(inputs["r"][3 * k : 3 * k + 3])
        A[body.name] = np.array(inputs["A"][9 * k : 9 * k + 9]).reshape(3, 3).T
    return Moving(r, A, np.array(inputs["alpha"]))


def moved(assembly: Assembly, bodies: Moving, q: Array) -> Moving:
    """Move by an infinitesimal displacement [n], to first order."""
    r, A = dict(bodies.r), dict(bodies.A)
    for k, body in enumerate(assembly.scene.bodies):
        move, turn = q[6 * k : 6 * k + 3], q[6 * k + 3 : 6 * k + 6]
        r[body.name] = r[body.name] + (A[body.name] @ move if assembly.translations == "body" else move)
        A[body.name] = A[body.name] @ (EYE + skew(turn))
    return Moving(r, A, bodies.alpha + q[6 * len(assembly.scene.bodies) :])


def geometry(joint: Joint, form: str, turns: Any, like: Any) -> Geometry:
    """Geometry of a joint, in the frames that its form takes."""
    (s_i, C_i), (s_j, C_j) = (
        (cast(np.array(m.point, dtype=float), like), cast(np.array(m.axes, dtype=float), like))
        for m in markers(joint, form)
    )
    return Geometry(s_i, C_i, s_j, C_j, cast(float(joint.pitch), like)[()], cast(0.0, like)[()], turns)


def tensors(assembly: Assembly, inputs: Mapping[str, Any]) -> tuple[Array, Array, Array]:
    """phi [m], phi_q [m, n] and d(phi_q[m, l])/dq_k [m, n (outer k), n (inner l)], all rows of all joints."""
    size = 6 * len(assembly.scene.bodies) + len(inputs["alpha"])
    like = inputs["r"][0]
    outer, inner = infinitesimals(size, like)
    bodies = start(assembly, inputs)
    there = moved(assembly, bodies, outer)
    values, first, second = [], [], []
    turns = iter(inputs["revolutions"])
    alpha = 0
    for joint in assembly.scene.joints:
        variant = assembly.forms[joint.name]
        is_counting = joint.type == "screw" and variant.form == "conventional"
        counted = next(turns) if is_counting else cast(0.0, like)[()]
        data = geometry(joint, variant.form, counted, like)
        own = slice(alpha, alpha + coordinates_of(variant))
        alpha = own.stop

        def of(moving: Moving, joint: Joint = joint, own: slice = own) -> Pose:
            i, j = joint.bodies
            return Pose(moving.r[i], moving.A[i], moving.r[j], moving.A[j], moving.alpha[own])

        values.append(phi(joint.type, variant.form, variant.rows, of(bodies), data))
        here = there
        if variant.derivative == "substituted":
            at = substitute(joint.type, variant.rows, of(there), data)
            j = joint.bodies[1]
            here = Moving({**there.r, j: at.r_j}, {**there.A, j: at.A_j}, there.alpha)
        rows = phi(joint.type, variant.form, variant.rows, of(moved(assembly, here, inner)), data)
        first.append(np.array([row.inner for row in rows]))
        second.append(np.array([row.cross for row in rows]))
    return np.concatenate(values), np.concatenate(first), np.concatenate(second)


def quantities(assembly: Assembly, inputs: Mapping[str, Any]) -> dict[str, Array]:
    """All quantities with the rows of the scene."""
    phi_of, first, second = tensors(assembly, inputs)
    kept = list(assembly.rows)
    multipliers, velocity = np.array(inputs["lambda"]), np.array(inputs["velocity"])
    gamma = -((second @ velocity) @ velocity)
    if assembly.translations == "body":
        rate = velocity * 0
        for k in range(len(assembly.scene.bodies)):
            move, turn = velocity[6 * k : 6 * k + 3], velocity[6 * k + 3 : 6 * k + 6]
            rate[6 * k : 6 * k + 3] = -(skew(turn) @ move)
        gamma = gamma - first @ rate
    return {
        "phi": phi_of[kept, None],
        "phi_q": first[kept],
        "phi_q_t_lambda_q": np.tensordot(multipliers, second[kept], axes=(0, 0)).T,
        "gamma": gamma[kept, None],
        "phi_q_v": (first @ velocity)[kept, None],
        "phi_q_v_q": (second @ velocity)[kept],
        "phi_q_t_lambda": (first[kept].T @ multipliers)[:, None],
    }
