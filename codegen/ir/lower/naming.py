"""Names and definitions for readers of the emitted code: ``h_j_in_i``, ``A_ij``, ``d_ij_world``, ``M_0``.

A value is named after what it is and the frame it is written in; sums that have no name in the papers are numbered in
the order in which they are computed, with their definition in the legend.
"""

from __future__ import annotations

from collections.abc import Mapping

from codegen.ir.lower.alternatives import Key
from codegen.ir.lower.polynomial import Polynomial
from codegen.ir.lower.quantities import Axis, Cross, Dyadic, Given, Named, Vector
from codegen.ir.lower.space import Space

_LONGEST = 96


class Naming:
    """Names nodes.

    Args:
        space: vectors and scalars.
        axes: frame -> names of its axes.
        vectors: named sums.
    """

    def __init__(self, space: Space, axes: Mapping[str, tuple[str, ...]], vectors: Mapping[Vector, str]) -> None:
        self._space = space
        self._axes = axes
        self._vectors = dict(vectors)
        self._numbered: dict[str, int] = {}
        self._blocks: dict[Dyadic, str] = {}

    def of(self, key: Key) -> tuple[str, str, int] | None:
        """Name, definition and index of the first entry of a node; None for one that needs no name."""
        match key[0]:
            case "vector" | "pushed" | "pulled":
                return self._vector(key[1], key[2])
            case "scalar":
                return self._scalar(key[1])
            case "pairs":
                return self._pairs(key[1], key[2], key[3])
        return None

    def _vector(self, vector: Vector, frame: str) -> tuple[str, str, int] | None:
        primitive = vector.single
        description = self._space.primitives[primitive] if primitive is not None else None
        if isinstance(description, Axis) and description.frame not in self._axes:
            return self._rotation(description, frame)
        if description is not None:
            name = self._primitive(primitive or 0)
            return f"{name}_{_place(frame)}", f"{self._plain(primitive or 0)}, {_axes_of(frame)}", 0
        if vector not in self._vectors:
            self._vectors[vector] = self._next("v")
        definition = self.vector(vector)
        return f"{self._vectors[vector]}_{_place(frame)}", _short(f"{definition}, {_axes_of(frame)}"), 0

    def _rotation(self, axis: Axis, frame: str) -> tuple[str, str, int]:
        """A column of the rotation from the frame of the axis to another."""
        frames = (frame, axis.frame)
        name = "A_" + "_".join(f.replace(" ", "_") for f in frames)
        return (
            name.replace("A_i_j", "A_ij").replace("A_j_i", "A_ji"),
            f"turns {frames[1]} axes to {frames[0]} axes",
            3 * axis.k,
        )

    def _scalar(self, value: Polynomial) -> tuple[str, str, int] | None:
        if value.constant is not None:
            return None
        monomial, coefficient = value.terms[0]
        if len(value.terms) > 1 or len(monomial) != 1 or coefficient != 1:
            return None
        atom = self._space.atoms[monomial[0]]
        if atom.kind == "stage" and str(atom.key[0]).isidentifier():
            return str(atom.key[0]), "", 0
        if atom.kind == "dot":
            p, q = atom.key
            return f"{self._primitive(p)}_dot_{self._primitive(q)}", f"{self._plain(p)} . {self._plain(q)}", 0
        return None

    def _pairs(self, pairs: Dyadic, rows: str, columns: str) -> tuple[str, str, int]:
        if pairs not in self._blocks:
            self._blocks[pairs] = self._next("M")
        terms: dict[int, dict[int, Polynomial]] = {}
        for (a, b), c in pairs.pairs:
            terms.setdefault(b, {})[a] = c
        definition = " + ".join(f"({self.vector(Vector(left))}) {self._plain(b)}^T" for b, left in terms.items())
        place = f"rows in {_axes_of(rows)}, columns in {_axes_of(columns)}"
        name = f"{self._blocks[pairs]}_{_place(rows).removeprefix('in_')}_{_place(columns).removeprefix('in_')}"
        return name, _short(f"{definition}; {place}"), 0

    def _next(self, letter: str) -> str:
        number = self._numbered.get(letter, 0)
        self._numbered[letter] = number + 1
        return f"{letter}_{number}"

    # --- words

    def vector(self, vector: Vector) -> str:
        """A vector in the notation of the papers."""
        if vector in self._vectors and not self._vectors[vector].startswith("v_"):
            return self._vectors[vector]
        words = []
        for primitive, coefficient in vector.terms:
            factor = self.scalar(coefficient)
            factor = "" if factor == "1" else "-" if factor == "-1" else f"{_enclosed(factor)} "
            words.append(f"{factor}{self._plain(primitive)}")
        return " + ".join(words).replace("+ -", "- ")

    def scalar(self, value: Polynomial) -> str:
        """A scalar in the notation of the papers."""
        words = []
        for monomial, coefficient in value.terms:
            factors = " ".join(self._atom(index) for index in monomial)
            number = "" if abs(coefficient) == 1 and monomial else str(abs(coefficient))
            words.append(("-" if coefficient < 0 else "") + " ".join(part for part in (number, factors) if part))
        return " + ".join(words).replace("+ -", "- ") or "0"

    def _atom(self, index: int) -> str:
        atom = self._space.atoms[index]
        if atom.kind == "raw":
            return f"({self.vector(atom.key[0])} . {self.vector(atom.key[1])})"
        if atom.kind in ("dot", "triple"):
            return "(" + " . ".join(self._plain(p) for p in atom.key) + ")"
        return str(atom.key[0])

    def _primitive(self, number: int) -> str:
        """A primitive as part of an identifier."""
        description = self._space.primitives[number]
        if isinstance(description, Axis):
            axes = self._axes.get(description.frame)
            return axes[description.k] if axes else f"{description.frame.replace(' ', '_')}_{'xyz'[description.k]}"
        if isinstance(description, Cross):
            return f"{self._primitive(description.left)}_cross_{self._primitive(description.right)}"
        return description.name

    def _plain(self, number: int) -> str:
        """A primitive in words."""
        description = self._space.primitives[number]
        if isinstance(description, Cross):
            return f"{self._plain(description.left)} x {self._plain(description.right)}"
        if isinstance(description, Given | Named):
            return description.name
        return self._primitive(number)


def _place(frame: str) -> str:
    return frame if frame == "world" else f"in_{frame.replace(' ', '_')}"


def _axes_of(frame: str) -> str:
    return f"{frame} axes" if frame == "world" else f"axes of {frame if ' ' in frame else 'body ' + frame}"


def _enclosed(text: str) -> str:
    return f"({text})" if " + " in text or " - " in text else text


def _short(text: str) -> str:
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 4].rsplit(' ', 1)[0]} ..."
