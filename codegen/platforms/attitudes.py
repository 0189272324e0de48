"""Rotation matrices as the attitude argument of a routine: matrix, quaternion or Euler angles."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from codegen.spec.scene import Matrix

Array = NDArray[np.float64]


def argument_name(attitude: str) -> str:
    """The name of the argument: ``R``, ``q`` or ``angles``."""
    return {"matrix": "R", "quaternion": "q"}.get(attitude, "angles")


def attitude_entries(attitude: str, rotation: Matrix) -> tuple[str, list[Fraction]]:
    """Name and entries, column-major, of the argument for a rotation, platform to base."""
    if attitude == "matrix":
        return "R", [rotation[i][k] for k in range(3) for i in range(3)]
    values = attitude_array(attitude, np.array([[[float(x) for x in row] for row in rotation]]))[:, 0]
    return argument_name(attitude), [Fraction(float(x)) for x in values]


def attitude_array(attitude: str, rotations: Array) -> Array:
    """Entries [n, poses] of the argument for rotation matrices [poses, 3, 3], platform to base."""
    if attitude == "matrix":
        return np.ascontiguousarray(rotations.transpose(2, 1, 0)).reshape(9, -1)
    found = Rotation.from_matrix(rotations)
    if attitude == "quaternion":
        return np.ascontiguousarray(found.as_quat(canonical=True)[:, [3, 0, 1, 2]].T)
    return np.ascontiguousarray(found.as_euler(attitude).T)


def rotations_of(attitude: str, entries: Array) -> Array:
    """Rotation matrices [poses, 3, 3] of the entries [n, poses] of an argument."""
    if attitude == "matrix":
        return entries.reshape(3, 3, -1).transpose(2, 1, 0)
    if attitude == "quaternion":
        return np.asarray(Rotation.from_quat(entries[[1, 2, 3, 0]].T).as_matrix())
    return np.asarray(Rotation.from_euler(attitude, entries.T).as_matrix())
