"""Rotation matrices of many bodies: the exponential map of SO(3) and its inverse (``delta A = A delta pi~``)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

Array = NDArray[np.float64]


def turned(A: Array, vectors: Array) -> Array:
    """Turn attitudes [nb, 3, 3] by rotation vectors [nb, 3] rad in body axes: ``A exp(v~)``."""
    if not len(A):
        return A
    return np.asarray(A @ Rotation.from_rotvec(vectors).as_matrix())


def turns(A: Array, other: Array) -> Array:
    """Rotation vectors [nb, 3] rad in body axes that lead from attitudes [nb, 3, 3] to others."""
    if not len(A):
        return np.zeros((0, 3))
    return np.asarray(Rotation.from_matrix(np.swapaxes(A, 1, 2) @ other).as_rotvec())
