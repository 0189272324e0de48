"""How the bodies of a scene are laid out in arrays: in space, or in the plane.

In space each body has a position [3], an attitude [3, 3] and six displacements. In the plane (world x and y) it has a
position [2], an attitude [2, 2] and three displacements, ``delta x``, ``delta y`` and the turn about the normal.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import sympy

from codegen.mechanics import frames


@dataclass(frozen=True)
class Arrays:
    """Strides of the arrays of bodies.

    Attributes:
        position: scalars of a position.
        attitude: scalars of an attitude, column-major.
        derived: displacements of a body as they are derived: in the plane ``delta r`` still has three components.
        kept: those of the derived displacements that the body has.
    """

    position: int
    attitude: int
    derived: int
    kept: tuple[int, ...]

    @property
    def is_planar(self) -> bool:
        """Whether the bodies move in the plane."""
        return self.position == 2

    @property
    def displacements(self) -> int:
        """Displacements of a body."""
        return len(self.kept)

    def inputs(self, body: str, number: int) -> dict[Any, tuple[str, int]]:
        """Say for each symbol of a body which argument it is read from, and at which offset.

        Args:
            body: identifier of the body.
            number: of the body.
        """
        rate = self.displacements * number
        if not self.is_planar:
            places = (("r", 3 * number), ("A", 9 * number), ("velocity", rate), ("velocity", rate + 3))
            found = {body_symbol(word, body): place for word, place in zip(BODY_SYMBOLS, places, strict=True)}
            coordinates = frames.components(body_symbol("r", body))
            return found | {coordinate: ("r", 3 * number + k) for k, coordinate in enumerate(coordinates)}
        x, y = planar_symbols("r", body)
        v_x, v_y = planar_symbols("v", body)
        cosine, sine = planar_symbols("A", body)
        (turning,) = planar_symbols("omega", body)
        found = {x: ("r", 2 * number), y: ("r", 2 * number + 1), cosine: ("A", 4 * number), sine: ("A", 4 * number + 1)}
        return found | {v_x: ("velocity", rate), v_y: ("velocity", rate + 1), turning: ("velocity", rate + 2)}

    def components(self, body: str) -> dict[Any, Any]:
        """What is known of the vectors of a body: in the plane their third components, or all others, are zero."""
        if not self.is_planar:
            return {}
        (turning,) = planar_symbols("omega", body)
        return {
            body_symbol("r", body): sympy.ImmutableDenseMatrix([*planar_symbols("r", body), 0]),
            body_symbol("v", body): sympy.ImmutableDenseMatrix([*planar_symbols("v", body), 0]),
            body_symbol("omega", body): sympy.ImmutableDenseMatrix([0, 0, turning]),
        }

    def attitude_matrix(self, body: str) -> Any | None:
        """The attitude of a body written out, where it is a turn about the normal; else None."""
        if not self.is_planar:
            return None
        cosine, sine = planar_symbols("A", body)
        return sympy.ImmutableDenseMatrix([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]])


SPATIAL = Arrays(3, 9, 6, (0, 1, 2, 3, 4, 5))
PLANAR = Arrays(2, 4, 4, (0, 1, 3))

BODY_SYMBOLS = ("r", "A", "v", "omega")
"""Position, attitude, velocity (axes of the virtual translations) and angular velocity (body axes) of a body."""

_PLANAR = {"r": ("x", "y"), "v": ("v_x", "v_y"), "A": ("cosine", "sine"), "omega": ("omega",)}


def body_symbol(word: str, body: str) -> Any:
    """Symbol of a body, such as ``r_crank``: one of `BODY_SYMBOLS`."""
    return frames.matrix(f"A_{body}") if word == "A" else frames.vector(f"{word}_{body}")


def normal_symbol(body: str) -> Any:
    """[3], the normal of the plane of motion as an axis of a body."""
    return frames.vector(f"plane_normal_{body}")


def planar_symbols(word: str, body: str) -> tuple[Any, ...]:
    """Scalars that a symbol of a body has in the plane."""
    return tuple(sympy.Symbol(f"{name}_of_{body}") for name in _PLANAR[word])
