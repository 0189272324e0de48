"""What a run asks of a chain: closure, Jacobians, inertia and forces as numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from codegen.chains.partition import Partition

if TYPE_CHECKING:
    from codegen.chains.rate_code import RateCode
    from codegen.chains.switches import Switch

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Closure:
    """How far the cuts are open: frame R seen from frame C, [nr] cuts.

    Attributes:
        p: [nr, 3] m, origin of R in axes of C.
        R: [nr, 3, 3] attitude.
        dp: [nr, 3, n] exact derivative of p.
        W: [nr, 3, n] angular velocity of R against C for unit rates, axes of C.
    """

    p: Array
    R: Array
    dp: Array
    W: Array


@dataclass(frozen=True, slots=True, eq=False)
class Terms:
    """Terms of ``J qdd + gamma = 0`` and ``M qdd + f_C = f_G + tau + J^T f_R``.

    Attributes:
        gamma: [6 nr].
        M: [n, n].
        f_C: [n].
        f_G: [n].
    """

    gamma: Array
    M: Array
    f_C: Array
    f_G: Array


class Equations(Protocol):
    """The equations of a chain of n links with nr cuts and ne end effectors."""

    @property
    def binding(self) -> tuple[bool, ...]:
        """Of each row of the cuts [6 nr], whether a coordinate moves it: those that are structurally zero do not."""

    def closure(self, q: Array) -> Closure:
        """Evaluate the cuts."""

    def constraint(self, q: Array) -> tuple[Array, Array] | None:
        """Evaluate ``(p; 2e)`` of all cuts [6 nr] and its derivative [6 nr, n], rows that do not bind being 0.

        None where a cut is turned by more than 120 degrees, or where it is to be found from the closure.
        """

    def jacobian(self, q: Array) -> Array:
        """Evaluate J [6 nr, n], rows linear then angular for each cut, axes of C."""

    def gamma(self, q: Array, qd: Array) -> Array:
        """Evaluate gamma_R [6 nr]."""

    def code(self, part: Partition, is_driven: NDArray[np.bool_], switches: Sequence[Switch]) -> RateCode | None:
        """Compile the motion by the independent coordinates [nv]; None where it is not generated."""

    def terms(self, q: Array, qd: Array) -> Terms:
        """Evaluate the terms of the equations of motion."""

    def applied(self, q: Array, qd: Array, on: Array) -> tuple[Array, Array]:
        """Evaluate what acts on coordinates [n] and at effectors [6 ne], axes of these.

        Args:
            q: [n].
            qd: [n].
            on: 1 for each force that switches and acts, 0 for one that does not.
        """

    def effectors(self, q: Array) -> Array:
        """Evaluate D_E [6 ne, n], axes of the effectors."""
