"""The chain reduced to its independent coordinates, at a closed pose.

With ``K = J_w^+ J_v`` all rates are ``qd = N qd_v``, ``N = [1; -K]``, and all accelerations ``qdd = N qdd_v + a``; a is
0 for the independent and ``-J_w^+ gamma_R`` for the dependent coordinates. The equation of motion is

    ``(N^T M N) qdd_v = N^T (f_G + tau + D_E^T f_E - f_C - M a)``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lapack

from codegen.chains.equations import Equations, Terms
from codegen.chains.factor import Factor, factor
from codegen.chains.partition import Partition

Array = NDArray[np.float64]


_LEAST_INERTIA = 1e-13
"""Eigenvalue of the inertia matrix with ones on its diagonal: below, it is 0."""


class NoInertia(Exception):
    """The reduced inertia matrix is singular.

    Attributes:
        free: [nv] direction of independent coordinates that nothing resists.
    """

    def __init__(self, free: Array) -> None:
        super().__init__()
        self.free = free


@dataclass(frozen=True, slots=True, eq=False)
class Rates:
    """The motion of a chain at a closed pose.

    Attributes:
        part: coordinates and rows.
        factor: of the dependent columns of J, without dimension.
        N: [n, nv] rates for rates of the independent coordinates.
        qd: [n].
        a: [n] accelerations without those of the independent coordinates.
    """

    part: Partition
    factor: Factor
    N: Array
    qd: Array
    a: Array

    def acceleration(self, qdd_v: Array) -> Array:
        """Give all accelerations [n]."""
        return np.asarray(self.N @ qdd_v + self.a)


@dataclass(frozen=True, slots=True, eq=False)
class Reduced:
    """A chain at a pose and velocity, with its inertia and forces."""

    rates: Rates
    terms: Terms

    def forward(self, force: Array, driven: NDArray[np.bool_], given: Array) -> Array:
        """Give the accelerations of the independent coordinates [nv].

        Args:
            force: [n] generalised, beside gravity, without the efforts of driven coordinates.
            driven: [nv] coordinates whose accelerations are prescribed.
            given: [nd] these accelerations.

        Raises:
            NoInertia: nothing resists one of the others.
        """
        terms, N, free = self.terms, self.rates.N, ~driven
        inertia, found = N.T @ terms.M @ N, np.zeros(len(driven))
        found[driven] = given
        rest = N.T @ (terms.f_G + force - terms.f_C - terms.M @ self.rates.a) - inertia @ found
        try:
            found[free] = _solved(inertia[np.ix_(free, free)], rest[free])
        except NoInertia as lack:
            whole = np.zeros(len(driven))
            whole[free] = lack.free
            raise NoInertia(whole) from None
        return found

    def inverse(self, qdd: Array, force: Array) -> Array:
        """Give the efforts on the independent coordinates [nv].

        Args:
            qdd: [n] accelerations.
            force: [n] generalised, beside gravity and the efforts.
        """
        return np.asarray(self.rates.N.T @ self._missing(qdd, force))

    def reaction(self, qdd: Array, force: Array) -> Array:
        """Give the reactions of the cuts on their frames R [6 nr], axes of R.

        Rows that do not bind are 0; where rows depend on each other the smallest reactions are taken.

        Args:
            qdd: [n] accelerations.
            force: [n] generalised, beside gravity, on dependent coordinates as well.
        """
        part, found = self.rates.part, np.zeros(len(self.terms.gamma))
        missing = self._missing(qdd, force)[part.w] * part.units[part.w]
        found[part.rows] = self.rates.factor.solve_transposed(missing) / part.row_units[part.rows]
        return found

    def kinetic_energy(self) -> float:
        """Give the kinetic energy, J."""
        return float(self.rates.qd @ self.terms.M @ self.rates.qd / 2)

    def _missing(self, qdd: Array, force: Array) -> Array:
        terms = self.terms
        return np.asarray(terms.M @ qdd + terms.f_C - terms.f_G - force)


def _solved(inertia: Array, rest: Array) -> Array:
    """Accelerations for a symmetric positive inertia matrix, by Cholesky's factors."""
    if not len(rest):
        return rest
    diagonal = np.diagonal(inertia)
    scale = 1 / np.sqrt(np.where(diagonal > 0, diagonal, 1.0))
    scaled = inertia * np.outer(scale, scale)
    packed, info = lapack.dpotrf(scaled)
    if info or np.min(np.diagonal(packed), initial=1.0) ** 2 < _LEAST_INERTIA:
        raise NoInertia(np.linalg.eigh(scaled)[1][:, 0] * scale)
    return np.asarray(scale * lapack.dpotrs(packed, scale * rest)[0])


def rates(equations: Equations, part: Partition, q: Array, qd_v: Array) -> Rates:
    """Give the rates at a closed pose.

    Args:
        equations: of the chain.
        part: its coordinates and rows.
        q: [n], closed.
        qd_v: [nv].

    Raises:
        RankLoss: the pose is singular.
    """
    tangent = _Tangent(equations, part, q)
    return tangent.rates(qd_v, equations.gamma(q, tangent.N @ qd_v))


def reduced(equations: Equations, part: Partition, q: Array, qd_v: Array) -> Reduced:
    """Reduce a chain at a closed pose: its rates, as `rates` has them, with inertia and forces.

    Raises:
        RankLoss: the pose is singular.
    """
    tangent = _Tangent(equations, part, q)
    terms = equations.terms(q, tangent.N @ qd_v)
    return Reduced(tangent.rates(qd_v, terms.gamma), terms)


class _Tangent:
    """What follows from the pose alone: the factor of the dependent columns of J, and N."""

    def __init__(self, equations: Equations, part: Partition, q: Array) -> None:
        J = equations.jacobian(q)
        self.part, self.factor = part, factor(part.dependent(J))
        self.N = np.zeros((len(q), len(part.v)))
        self.N[part.v, np.arange(len(part.v))] = 1.0
        self.N[part.w] = -part.units[part.w, None] * self.factor.solve(part.binding(J[:, part.v]))

    def rates(self, qd_v: Array, gamma: Array) -> Rates:
        """The rates, with gamma_R at them."""
        part, a = self.part, np.zeros(len(self.N))
        a[part.w] = -part.units[part.w] * self.factor.solve(part.binding(gamma))
        return Rates(part, self.factor, self.N, self.N @ qd_v, a)
