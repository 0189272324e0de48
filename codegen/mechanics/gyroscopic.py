"""The gyroscopic moment ``-omega x J omega`` of a body and its derivative by omega, component by component.

Written out, ``-(omega x J omega)_x = (J_y - J_z) omega_y omega_z`` takes two multiplications for a diagonal inertia
where the vectors take three and a subtraction. A row of J with products of inertia is a momentum of its own.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import sympy

from codegen.mechanics.placed import rational
from codegen.spec.scene import Body


@dataclass(frozen=True)
class Gyroscopic:
    """The gyroscopic moment of a body.

    Attributes:
        body: for its inertia, [3, 3] kg m^2, body axes.
        name: identifier of the body.
        omega: the three components of its angular velocity, scalar symbols, body axes.
    """

    body: Body
    name: str
    omega: tuple[Any, Any, Any]

    @property
    def stages(self) -> dict[Any, Any]:
        """Momenta of their own, N m s."""
        return {self._momentum(k): self._sum(k) for k in range(3) if self._has_products(k)}

    def moment(self, k: int) -> Any:
        """Component k, N m."""
        p, q = (k + 1) % 3, (k + 2) % 3
        return sympy.factor_terms(sympy.expand(self.omega[q] * self._momentum(p) - self.omega[p] * self._momentum(q)))

    def by_omega(self, k: int, n: int) -> Any:
        """Derivative of component k by component n of omega, N m s."""
        p, q = (k + 1) % 3, (k + 2) % 3
        change = self.omega[q] * self._inertia(p, n) - self.omega[p] * self._inertia(q, n)
        change += self._momentum(p) if n == q else 0
        change -= self._momentum(q) if n == p else 0
        return sympy.factor_terms(sympy.expand(change))

    def _inertia(self, k: int, n: int) -> Any:
        return rational(self.body.inertia[k][n])

    def _has_products(self, k: int) -> bool:
        return any(self.body.inertia[k][n] for n in range(3) if n != k)

    def _sum(self, k: int) -> Any:
        return sum(self._inertia(k, n) * self.omega[n] for n in range(3))

    def _momentum(self, k: int) -> Any:
        return sympy.Symbol(f"momentum_{k}_{self.name}") if self._has_products(k) else self._sum(k)
