"""Rotations of a cut: the quaternion of a matrix without loss of digits, the rotation vector and its derivative."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_SMALL = 1e-4
"""rad; below, series."""


def quaternion(R: Array) -> Array:
    """Give (e0, e) of a rotation matrix, e0 not negative; the divisor is the largest of the four (Shepperd)."""
    trace = R[0, 0] + R[1, 1] + R[2, 2]
    candidates = (trace, R[0, 0], R[1, 1], R[2, 2])
    largest = int(np.argmax(candidates))
    if largest == 0:
        found = np.array([1 + trace, R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
    else:
        i = largest - 1
        j, k = (i + 1) % 3, (i + 2) % 3
        found = np.empty(4)
        found[0] = R[k, j] - R[j, k]
        found[1 + i] = 1 + R[i, i] - R[j, j] - R[k, k]
        found[1 + j] = R[j, i] + R[i, j]
        found[1 + k] = R[k, i] + R[i, k]
    found /= np.sqrt(found @ found)
    return -found if found[0] < 0 else found


def rotation_vector(e: Array) -> Array:
    """Give the axis times the angle, at most pi, of a quaternion with e0 not negative."""
    size = float(np.sqrt(e[1:] @ e[1:]))
    if size < _SMALL:
        return np.asarray(2 * e[1:] * (1 + size**2 / 6))
    return np.asarray(2 * np.arctan2(size, e[0]) * e[1:] / size)


def rotation_vector_slope(u: Array) -> Array:
    """Give d(rotation vector)/d(rotation) [3, 3]: of ``R`` to ``exp(w~) R``, for a small w; regular at half turns."""
    angle = float(np.sqrt(u @ u))
    if angle < _SMALL:
        quotient = 1 / 12 + angle**2 / 720
    else:
        quotient = (1 - angle / 2 / np.tan(angle / 2)) / angle**2
    cross = skew(u)
    return np.asarray(np.eye(3) - cross / 2 + quotient * cross @ cross)


def skew(a: Array) -> Array:
    """``a~``."""
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])
