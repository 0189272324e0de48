"""Gradients of D and C by the pose and by the joints: 42 directions, eigenvectors held fixed.

Every index changes by ``tr(M' dJ)`` times itself. For a unit vector u of a value k and the motion x of the platform
that belongs to it (u and what accompanies it), ``k^2 = |J x|^2`` and ``d log k = (J x)' dJ x / k^2``, so that M is an
outer product; for D it is ``J X X'`` with the columns of T^-1 in the place of u. The vectors' own changes do not
matter at first order; where values are equal, some vector of theirs gives a slope in one of the directions that there
are.

``dJ`` of a leg: ``dl = dp + do - dB``, ``de = (I - e e') dl / |l|``, ``dp = w x p + R dp'``.
"""

from __future__ import annotations

import sympy

from codegen.ir.lower.staged import Stages
from codegen.mechanics.velocity.blocks import Blocks
from codegen.mechanics.velocity.eigenvalues import deviator
from codegen.mechanics.velocity.geometry import Legs
from codegen.mechanics.velocity.spectra import gram, gram_of_inverse
from codegen.mechanics.velocity.triangular import Triangle, solved
from codegen.mechanics.velocity.vectors import largest_vector
from codegen.spec.platform import LEGS

BLOCKS = ("sigma", "beta", "alpha", "gamma")

DIRECTIONS = 6 + 6 * LEGS
"""Origin (3), turn about axes of the base (3), joints on the base (18), joints on the platform (18)."""


def gradients(
    stages: Stages, legs: Legs, found: Blocks, indices: dict[str, list[sympy.Expr]]
) -> dict[str, sympy.Matrix]:
    """The quantities ``dD`` and ``dC`` [4, 42] in the length unit.

    Args:
        stages: gets the steps.
        legs: with J, and what it is made of.
        found: its factors.
        indices: ``D`` and ``C`` of the four blocks, as far as their gradients are wanted.
    """
    J = sympy.Matrix.hstack(legs.J1, legs.J2)
    w = -solved(stages, "w_of_v_grad", found.gamma, found.R12)
    v = -solved(stages, "v_of_w_grad", found.beta, found.S12)
    W, V = (stages.stage(f"{n}_with", m, "accompanying motion") for n, m in (("w", w), ("v", v)))
    none = sympy.zeros(3, 3)
    motions = {
        "sigma": sympy.Matrix.vstack(sympy.eye(3), W),
        "beta": sympy.Matrix.vstack(sympy.eye(3), none),
        "alpha": sympy.Matrix.vstack(V, sympy.eye(3)),
        "gamma": sympy.Matrix.vstack(none, sympy.eye(3)),
    }
    result = {}
    for what, of in indices.items():
        rows = []
        for block, index in zip(BLOCKS, of, strict=True):
            name = f"{what}_{block}"
            M = (_of_product if what == "D" else _of_ratio)(stages, name, J, motions[block], getattr(found, block))
            rows.append(index * _by_direction(stages, name, legs, M))
        result[f"d{what}"] = sympy.Matrix.vstack(*rows)
    return result


def _of_product(stages: Stages, name: str, J: sympy.Matrix, motion: sympy.Matrix, triangle: Triangle) -> sympy.Matrix:
    X = stages.stage(f"X_{name}", motion * triangle.inverse, "motions that give the legs orthonormal speeds")
    r = stages.stage(f"JX_{name}", J * X, "these speeds")
    return stages.stage(f"M_{name}", r * X.T, "d log D = tr(M' dJ)")


def _of_ratio(stages: Stages, name: str, J: sympy.Matrix, motion: sympy.Matrix, triangle: Triangle) -> sympy.Matrix:
    grams = (gram(stages, triangle, f"grad_{name}"), gram_of_inverse(stages, triangle, f"grad_{name}"))
    parts = []
    for k, (A, words) in enumerate(zip(grams, ("greatest", "least"), strict=True)):
        place = f"{name}_{k + 1}"
        u = largest_vector(stages, deviator(stages, place, A))
        x = stages.stage(f"x_of_{place}", motion * u, f"motion of the {words} value")
        r = stages.stage(f"r_of_{place}", J * x, "speeds of the legs")
        scale = stages.stage(f"over_{place}", sympy.Matrix([1 / r.dot(r)]), "1 over their square")[0]
        parts.append(stages.stage(f"M_{place}", (r * scale) * x.T, f"d log of the {words} value"))
    return stages.stage(f"M_{name}", parts[0] - parts[1], "d log C = tr(M' dJ)")


def _by_direction(stages: Stages, name: str, legs: Legs, M: sympy.Matrix) -> sympy.Matrix:
    """``tr(M' dJ)`` [1, 42] for each direction."""
    by_base, by_joint, arms = [], [], []
    for i in range(LEGS):
        e, p, place = legs.J1[i, :].T, legs.arms[i], f"{name}_{i + 1}"
        a, b = M[i, :3].T, M[i, 3:].T
        by_e = stages.stage(f"by_e_{place}", a + b.cross(p), "by e")
        along = stages.stage(f"along_{place}", sympy.Matrix([e.dot(by_e)]), "its part along the leg")[0]
        across = stages.stage(f"across_{place}", by_e - along * e, "the rest")
        by_l = stages.stage(f"by_l_{place}", across * legs.inverses[i], "by l")
        by_p = stages.stage(f"by_p_{place}", by_l + e.cross(b), "by p")
        by_base.append(-by_l)
        by_joint.append(stages.stage(f"by_joint_{place}", legs.R.T * by_p, "by p', platform axes"))
        arms.append(stages.stage(f"by_turn_{place}", p.cross(by_p), "by a turn"))
    origin = stages.stage(f"by_o_{name}", -sum(by_base[1:], by_base[0]), "by o")
    turn = stages.stage(f"by_turns_{name}", sum(arms[1:], arms[0]), "by a turn")
    return sympy.Matrix.vstack(origin, turn, *by_base, *by_joint).T
