"""The eigenvector of the largest eigenvalue of a symmetric 3 x 3 matrix, finite whatever values are equal.

Of the greatest and the least eigenvalue at least one is well apart from the others. Its vector is the longest cross
product of two rows of ``B - mu I``; if it is the least one, the vector of the greatest lies across it and comes from a
2 x 2 problem. Where two values are equal, some vector of their plane is given.
"""

from __future__ import annotations

from collections.abc import Callable

import sympy

from codegen.ir.lower.staged import Select, Stages
from codegen.mechanics.velocity.eigenvalues import Deviator, reach
from codegen.mechanics.velocity.triangular import TINY

Stage = Callable[..., sympy.Matrix]


def largest_vector(stages: Stages, found: Deviator) -> sympy.Matrix:
    """The unit eigenvector [3] of the largest eigenvalue.

    Args:
        stages: gets the steps.
        found: the matrix without its trace.
    """
    name = found.name

    def stage(what: str, words: str, *values: sympy.Expr) -> sympy.Matrix:
        return stages.stage(f"{what}_{name}", sympy.Matrix(list(values)), words)

    up, down = (reach(stages, found, side) for side in (1, -1))
    (mu,) = stage("mu", "the eigenvalue of B that is well apart", Select(up, down, -down, up))
    (y,) = stage("b_22", "entry of B", -found.half - found.last / 2)
    u, v, w = found.off
    B = sympy.Matrix([[-y - found.last, u, v], [u, y, w], [v, w, found.last]])
    n = _apart(stage, B, mu)
    a, b = _across(stage, n)
    Ba, Bb = (stage(f"B{k}", f"B {k}", *(B * v)) for k, v in (("a", a), ("b", b)))
    p, q, r = stage("plane", "B in the plane across n", a.dot(Ba), a.dot(Bb), b.dot(Bb))
    (d,) = stage("skew", "half of the difference of its diagonal", p / 2 - r / 2)
    (h,) = stage("radius", "half of the distance of its eigenvalues", sympy.sqrt(d * d + q * q))
    x, y = stage("pair", "its vector, to scale", Select(d, 0, q, d + h), Select(d, 0, h - d, q))
    (length,) = stage("pair_norm", "length of it", sympy.sqrt(x * x + y * y))
    (scale,) = stage("pair_scale", "1 over it", Select(length, TINY, 0, 1 / length))
    x, y = stage(
        "turned", "unit vector; the first axis if both are equal", Select(length, TINY, 1, x * scale), y * scale
    )
    inside = stage("inside", "vector in the plane", *(x * a + y * b))
    return stage("u", "largest eigenvector", *(Select(up, down, inside[k], n[k]) for k in range(3)))


def _apart(stage: Stage, B: sympy.Matrix, mu: sympy.Expr) -> sympy.Matrix:
    """The longest cross product of two rows of ``B - mu I``, of length 1."""
    M = B - mu * sympy.eye(3)
    diagonal = stage("shifted", "diagonal of B - mu I", *(M[k, k] for k in range(3)))
    M = sympy.Matrix(3, 3, lambda i, k: diagonal[i] if i == k else B[i, k])
    pairs = ((0, 1), (0, 2), (1, 2))
    products = [
        stage(f"cross_{k}", f"cross product of rows {i + 1}, {j + 1}", *M[i, :].cross(M[j, :]))
        for k, (i, j) in enumerate(pairs)
    ]
    squares = stage("squares_of_cross", "their squares", *(v.dot(v) for v in products))
    best, size = products[0], squares[0]
    for k in (1, 2):
        best = stage(f"best_{k}", "the longest", *(Select(size, squares[k], products[k][i], best[i]) for i in range(3)))
        (size,) = stage(f"size_{k}", "its square", Select(size, squares[k], squares[k], size))
    (scale,) = stage("n_scale", "1 over its length", 1 / sympy.sqrt(size))
    return stage("n", "vector of the eigenvalue that is well apart", *(best * scale))


def _across(stage: Stage, n: sympy.Matrix) -> tuple[sympy.Matrix, sympy.Matrix]:
    """Two unit vectors that are across another and each other."""
    x, y, z = n
    sizes = stage("sizes", "sizes of its first components", sympy.Abs(x), sympy.Abs(y))
    (longer,) = stage("longer", "the greater", Select(sizes[0], sizes[1], y, x))
    (scale,) = stage("a_scale", "1 over a length", 1 / sympy.sqrt(z * z + longer * longer))
    ends = stage("ends_of_a", "components of a", z * scale, longer * scale)
    a = stage(
        "a",
        "across n",
        Select(sizes[0], sizes[1], 0, -ends[0]),
        Select(sizes[0], sizes[1], ends[0], 0),
        Select(sizes[0], sizes[1], -ends[1], ends[1]),
    )
    return a, stage("b_axis", "across both", *n.cross(a))
