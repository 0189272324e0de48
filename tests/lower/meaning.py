"""What a node means, in numbers: vectors as components in the outermost frame, products by their definitions.

This knows the frames and the definitions of primitives and atoms, and none of the identities by which they are reduced.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np

from codegen.ir.lower.alternatives import Key
from codegen.ir.lower.frames import Component, FrameTree
from codegen.ir.lower.polynomial import Polynomial
from codegen.ir.lower.quantities import Axis, Cross, Dyadic, Given, Vector
from codegen.ir.lower.read import Definitions
from codegen.ir.lower.space import Space

from .numbers import Inputs, Numbers, arc_tangent, cosine, sine, skew

_FUNCTIONS = {"sin": sine, "cos": cosine, "atan2": arc_tangent, "same": lambda x: x, "ratio": lambda x, y: x / y}


class Meaning:
    """Values of vectors, scalars and maps at one set of inputs.

    Args:
        space: of the vectors and scalars.
        tree: of the frames; its matrices must be orthonormal at the inputs.
        definitions: of stage scalars.
        inputs: of the arguments.
        scalars: value of each symbol.
    """

    def __init__(
        self, space: Space, tree: FrameTree, definitions: Definitions, inputs: Inputs, scalars: Mapping[str, Any]
    ) -> None:
        self._space, self._tree, self._definitions = space, tree, definitions
        self._inputs, self.scalars = inputs, scalars
        self._primitives: dict[int, Numbers] = {}
        self._atoms: dict[int, Fraction] = {}
        self._turns: dict[str, Numbers] = {}

    def of(self, key: Key) -> list[Fraction]:
        """Entries of a node, a block row by row."""
        match key[0]:
            case "vector" | "pushed" | "pulled":
                return list(self.turn(key[2]).T @ self.vector(key[1]))
            case "scalar":
                return [self.scalar(key[1])]
            case "outer":
                return self._placed(np.outer(self.vector(key[1]), self.vector(key[2])), *key[3:])
            case "rotation":
                return self._placed(np.eye(3, dtype=object) * self.scalar(key[1]), *key[2:])
            case "tilde":
                return self._placed(skew(self.vector(key[1])), *key[2:])
            case "pairs" | "block":
                return self._placed(self.map(key[1]), *key[2:])
        raise AssertionError(f"a node of a kind that has no meaning: {key[0]}")

    def _placed(self, matrix: Numbers, rows: str, columns: str) -> list[Fraction]:
        return list((self.turn(rows).T @ matrix @ self.turn(columns)).ravel())

    def turn(self, frame: str) -> Numbers:
        """Rotation from a frame to the outermost one."""
        if frame not in self._turns:
            path = self._tree.path(frame, self._tree.frames[0])
            matrix = np.eye(3, dtype=object)
            for inner, outer in pairwise(path):
                columns = self._tree.matrix(outer, inner)
                assert columns is not None
                step = np.array([[self._component(entry) for entry in column] for column in columns], dtype=object).T
                matrix = step @ matrix
            self._turns[frame] = matrix
        return self._turns[frame]

    def _component(self, component: Component) -> Fraction:
        if isinstance(component, Polynomial):
            return self.scalar(component)
        return self._inputs[component[0]][component[1]]

    def vector(self, vector: Vector) -> Numbers:
        """Components in the outermost frame."""
        result = np.array([Fraction(0)] * 3, dtype=object)
        for primitive, coefficient in vector.terms:
            result = result + self.primitive(primitive) * self.scalar(coefficient)
        return result

    def primitive(self, number: int) -> Numbers:
        """Components of a primitive in the outermost frame."""
        if number not in self._primitives:
            self._primitives[number] = self._of_primitive(number)
        return self._primitives[number]

    def _of_primitive(self, number: int) -> Numbers:
        description = self._space.primitives[number]
        if isinstance(description, Axis):
            return self.turn(description.frame)[:, description.k]
        if isinstance(description, Given):
            components = self._tree.given[description.frame, description.name]
            return self.turn(description.frame) @ np.array([self._component(c) for c in components], dtype=object)
        if isinstance(description, Cross):
            return skew(self.primitive(description.left)) @ self.primitive(description.right)
        return self.vector(self._space.named[description.name])

    def scalar(self, value: Polynomial) -> Fraction:
        """Value of a polynomial."""
        result = Fraction(0)
        for monomial, coefficient in value.terms:
            term = Fraction(coefficient)
            for index in monomial:
                term *= self.atom(index)
            result += term
        return result

    def atom(self, index: int) -> Fraction:
        """Value of an atom."""
        if index not in self._atoms:
            self._atoms[index] = self._of_atom(index)
        return self._atoms[index]

    def _of_atom(self, index: int) -> Fraction:
        atom = self._space.atoms[index]
        match atom.kind:
            case "symbol":
                return Fraction(self.scalars[atom.key[0]])
            case "stage":
                function, arguments = self._definitions[atom.key[0]]
                return Fraction(_FUNCTIONS[function](*(self.scalar(argument) for argument in arguments)))
            case "dot":
                return Fraction(self.primitive(atom.key[0]) @ self.primitive(atom.key[1]))
            case "triple":
                a, b, c = (self.primitive(number) for number in atom.key)
                return Fraction((skew(a) @ b) @ c)
            case "raw":
                return Fraction(self.vector(atom.key[0]) @ self.vector(atom.key[1]))
        raise AssertionError(f"an atom of a kind that has no meaning: {atom.kind}")

    def map(self, dyadic: Dyadic) -> Numbers:
        """Matrix of a map in the outermost frame."""
        matrix = np.eye(3, dtype=object) * self.scalar(dyadic.identity) + skew(self.vector(dyadic.tilde))
        for (a, b), coefficient in dyadic.pairs:
            matrix = matrix + np.outer(self.primitive(a), self.primitive(b)) * self.scalar(coefficient)
        return np.asarray(matrix)
