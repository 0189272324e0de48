"""Rotations for any number type: skew matrices, the exponential map, elementary rotations, Euler parameters.

Matrices are [3x3], row index first; angles in radians.  SPEC S1.0 and the Table 3 of S1.2.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .scalars import Array, Scalar, cos, sin

SERIES_TERMS = 60  # exponential map: enough for |w| < 4 at 256 bits


def matrix(rows: list[list[Scalar]]) -> Array:
    """[3x3] array; of dtype object unless all entries are plain floats or complex numbers."""
    plain = all(isinstance(x, (int, float, complex, np.number)) for row in rows for x in row)
    out = np.empty((len(rows), len(rows[0])), dtype=object)
    for i, row in enumerate(rows):
        for j, x in enumerate(row):
            out[i, j] = x
    return np.array(rows) if plain else out


def skew(a: Array) -> Array:
    """a~ [3x3] with a~ b = a x b, a [3]."""
    o = a[0] * 0
    return matrix([[o, -a[2], a[1]], [a[2], o, -a[0]], [-a[1], a[0], o]])


def exp_map(w: Array) -> Array:
    """exp(w~) [3x3], w [3] rad.

    One power series in w.w, no branch and no norm, hence analytic: float, complex step, arb and Jet, also at
    w = 0.
    """
    square = w[0] * w[0] + w[1] * w[1] + w[2] * w[2]
    sine = term = square * 0 + 1
    for k in range(1, SERIES_TERMS):
        term = term * square / (-(2 * k) * (2 * k + 1))
        sine = sine + term
    versed = term = (square * 0 + 1) / 2
    for k in range(1, SERIES_TERMS):
        term = term * square / (-(2 * k + 1) * (2 * k + 2))
        versed = versed + term
    W = skew(w)
    return np.asarray(W * sine + (W @ W) * versed + np.eye(3, dtype=int))


def Rx(a: Scalar) -> Array:
    """Rotation by a about the first axis."""
    c, s, o = cos(a), sin(a), a * 0
    return matrix([[o + 1, o, o], [o, c, -s], [o, s, c]])


def Ry(a: Scalar) -> Array:
    """Rotation by a about the second axis."""
    c, s, o = cos(a), sin(a), a * 0
    return matrix([[c, o, s], [o, o + 1, o], [-s, o, c]])


def Rz(a: Scalar) -> Array:
    """Rotation by a about the third axis."""
    c, s, o = cos(a), sin(a), a * 0
    return matrix([[c, -s, o], [s, c, o], [o, o, o + 1]])


def from_euler_parameters(e: Array) -> Array:
    """(p0^2 - p.p) I + 2 p p^T + 2 p0 p~ [3x3], e = (p0, p) [4]; a rotation only when e.e = 1."""
    p_0, p = e[0], e[1:]
    square = p[0] * p[0] + p[1] * p[1] + p[2] * p[2]
    products = 2 * np.multiply.outer(p, p)
    return np.asarray(np.eye(3, dtype=int) * (p_0 * p_0 - square) + products + skew(p) * (2 * p_0))


def random_rotation(rng: np.random.Generator) -> NDArray[np.float64]:
    """Rotation [3x3], uniform on SO(3)."""
    e = rng.normal(size=4)
    return np.asarray(from_euler_parameters(e / np.linalg.norm(e)), dtype=float)
