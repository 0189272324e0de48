"""What is known of the entries of a quantity before any way to compute it is chosen: which are zero, which are one."""

from __future__ import annotations

from itertools import pairwise

from codegen.errors import InternalError
from codegen.ir.lower.alternatives import GENERAL, UNIT, ZERO, Key, inner_class
from codegen.ir.lower.frames import Component, FrameTree
from codegen.ir.lower.polynomial import Polynomial
from codegen.ir.lower.quantities import Axis, Cross, Given, Named, Vector
from codegen.ir.lower.space import Space


class EntryClasses:
    """Zero, one or general: what each entry of a quantity is known to be.

    Args:
        space: the vectors and scalars.
        tree: the frames.
    """

    def __init__(self, space: Space, tree: FrameTree) -> None:
        self._space = space
        self._tree = tree
        self._primitives: dict[tuple[int, str], tuple[int, ...]] = {}

    def of(self, key: Key) -> tuple[int, ...]:
        """Classes of the entries of a node."""
        match key[0]:
            case "vector" | "pushed" | "pulled":
                return self.vector(key[1], key[2])
            case "offset":
                return (GENERAL,) * 3
            case "scalar":
                return (scalar_class(key[1]),)
            case "outer":
                left, right = self.vector(key[1], key[3]), self.vector(key[2], key[4])
                return tuple(inner_class([(a, b)]) for a in left for b in right)
        return (GENERAL,) * 9

    def vector(self, vector: Vector, frame: str) -> tuple[int, ...]:
        """Classes of the components of a vector in a frame."""
        found = [ZERO] * 3
        for primitive, coefficient in vector.terms:
            factor = scalar_class(coefficient)
            for k, c in enumerate(self.primitive(primitive, frame)):
                term = inner_class([(factor, c)])
                found[k] = term if not found[k] else GENERAL if term else found[k]
        return tuple(found)

    def primitive(self, primitive: int, frame: str) -> tuple[int, ...]:
        """Classes of the components of a primitive in a frame."""
        key = primitive, frame
        if key not in self._primitives:
            self._primitives[key] = self._new_primitive(primitive, frame)
        return self._primitives[key]

    def _new_primitive(self, primitive: int, frame: str) -> tuple[int, ...]:
        description = self._space.primitives[primitive]
        if isinstance(description, Named):
            return self.vector(self._space.named[description.name], frame)
        if isinstance(description, Cross):
            left, right = (self.primitive(p, frame) for p in (description.left, description.right))
            return tuple(
                inner_class([(left[(k + 1) % 3], right[(k + 2) % 3]), (left[(k + 2) % 3], right[(k + 1) % 3])])
                for k in range(3)
            )
        known = self._at_home(description)
        path = self._tree.path(description.frame, frame)
        for inner, outer in pairwise(path):
            matrix = self._tree.matrix(outer, inner)
            if matrix is None:
                raise InternalError(f"no rotation from {inner} to {outer}")
            columns = [[component_class(entry) for entry in column] for column in matrix]
            known = tuple(inner_class([(columns[k][row], known[k]) for k in range(3)]) for row in range(3))
        return known if path else (GENERAL,) * 3

    def _at_home(self, description: Axis | Given) -> tuple[int, ...]:
        if isinstance(description, Axis):
            return tuple(UNIT if k == description.k else ZERO for k in range(3))
        return tuple(component_class(entry) for entry in self._tree.given[description.frame, description.name])


def scalar_class(value: Polynomial) -> int:
    """Class of a scalar."""
    constant = value.constant
    return GENERAL if constant is None else ZERO if not constant else UNIT if abs(constant) == 1 else GENERAL


def component_class(component: Component) -> int:
    """Class of a given component."""
    return scalar_class(component) if isinstance(component, Polynomial) else GENERAL
