"""What acts on a joint coordinate: a constant, a spring and damper, and soft stops.

A stop is smooth of every order. With ``x`` the way beyond it and ``rho = sqrt(x^2 + eps^2)`` its spring gives
``k (x + rho) / 2``, which is ``k x`` far beyond and 0 far before the stop, and its damper ``c s alphadot`` with the
share ``s = (1 + x / rho) / 2`` that is 1 far beyond and 0 far before; at the stop itself it is 1/2.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import sympy

from codegen.mechanics.placed import rational
from codegen.spec.scene import Coordinate, Limit

STOP_SMOOTHING = Fraction(1, 10_000)
"""``eps``, m or rad: over this way a soft stop takes hold; at the stop itself its spring gives ``k eps / 2``."""


@dataclass(frozen=True)
class CoordinateLoad:
    """The generalised force on a joint coordinate, N or N m, and its derivatives.

    Attributes:
        coordinate: what acts.
        alpha: symbol of the coordinate, m or rad.
        rate: symbol of its rate.
    """

    coordinate: Coordinate
    alpha: Any
    rate: Any

    @cached_property
    def stages(self) -> dict[Any, Any]:
        """Definitions of the roots of the stops."""
        return {symbol: definition for stop in self._stops for symbol, definition in stop.stages.items()}

    def value(self, name: str) -> Any:
        """Give ``force``, ``force_q`` or ``force_v``."""
        acting = self.coordinate
        k, c = rational(acting.stiffness), rational(acting.damping)
        match name:
            case "force":
                own = rational(acting.torque) - k * (self.alpha - rational(acting.rest)) - c * self.rate
                return own + sum(stop.force(self.rate) for stop in self._stops)
            case "force_q":
                return -k + sum(stop.by_coordinate(self.rate) for stop in self._stops)
        return -c + sum(stop.by_rate for stop in self._stops)

    @cached_property
    def _stops(self) -> list[Stop]:
        return [] if self.coordinate.limit is None else list(_stops(self.coordinate.limit, self.alpha))


@dataclass(frozen=True)
class Stop:
    """One soft stop.

    Attributes:
        name: of its stages.
        beyond: the way beyond it, ``x``.
        direction: 1 for an upper, -1 for a lower stop: ``dx/dalpha``.
        stiffness: ``k``.
        damping: ``c``.
    """

    name: str
    beyond: Any
    direction: int
    stiffness: Any
    damping: Any

    @property
    def _root(self) -> Any:
        return sympy.Symbol(f"rho_{self.name}")

    @property
    def _inverse(self) -> Any:
        return sympy.Symbol(f"inverse_rho_{self.name}")

    @property
    def _share(self) -> Any:
        return sympy.Symbol(f"share_{self.name}")

    @property
    def stages(self) -> dict[Any, Any]:
        """``rho``, ``1 / rho`` and ``s``."""
        return {
            self._root: sympy.sqrt(self.beyond**2 + rational(STOP_SMOOTHING) ** 2),
            self._inverse: 1 / self._root,
            self._share: (1 + self.beyond * self._inverse) / 2,
        }

    def force(self, rate: Any) -> Any:
        """Push back along the coordinate: ``k s rho`` is ``k (x + rho) / 2``."""
        push = self.stiffness * (self.beyond + self._root) / 2
        return -self.direction * push - self.damping * self._share * rate

    def by_coordinate(self, rate: Any) -> Any:
        """Derivative of the force by alpha; ``ds/dx = eps^2 / (2 rho^3)``."""
        change = rational(STOP_SMOOTHING) ** 2 * self._inverse**3 / 2
        return -self.stiffness * self._share - self.damping * self.direction * change * rate

    @property
    def by_rate(self) -> Any:
        """Derivative of the force by the rate of alpha."""
        return -self.damping * self._share


def _stops(limit: Limit, alpha: Any) -> Iterator[Stop]:
    k, c = rational(limit.stiffness), rational(limit.damping)
    if limit.upper is not None:
        yield Stop(f"upper_{alpha.name}", alpha - rational(limit.upper), 1, k, c)
    if limit.lower is not None:
        yield Stop(f"lower_{alpha.name}", rational(limit.lower) - alpha, -1, k, c)
