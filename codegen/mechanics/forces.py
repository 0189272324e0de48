"""Applied and gyroscopic forces of a scene: ``force``, the right-hand side of ``M a + phi_q^T lambda = force``.

Gravity, constant torques and forces in world axes, springs and dampers between points, what acts on joint coordinates,
and ``-omega x J omega``. ``force_q`` and ``force_v`` are its derivatives by the displacements and by the velocities,
whose components stay in the axes they are in. Rows and columns are the displacements of the assembly. Where virtual
translations are in body axes, forces are too.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any

import sympy

from codegen.errors import InternalError
from codegen.ir.lower import Block, Part, Places
from codegen.mechanics import frames
from codegen.mechanics.arrays import body_symbol, normal_symbol
from codegen.mechanics.assembly import Assembly
from codegen.mechanics.blocks import gathered
from codegen.mechanics.constant_load import ConstantLoad
from codegen.mechanics.coordinate_load import CoordinateLoad
from codegen.mechanics.gyroscopic import Gyroscopic
from codegen.mechanics.merged import merged
from codegen.mechanics.normal_turns import about_normal
from codegen.mechanics.placed import THIRD_AXIS, Ends, Placed
from codegen.mechanics.places import WORLD, places
from codegen.mechanics.spring import BALL, SpringLaw, spring_law
from codegen.spec.placement import IDENTITY
from codegen.spec.scene import GROUND, Body, Joint, Marker, Spring
from codegen.spec.sections import varying_of

FORCES = {
    "force": ("displacements", "one"),
    "force_q": ("displacements", "displacements"),
    "force_v": ("displacements", "displacements"),
}
"""What the rows and columns of a quantity are."""


@dataclass(frozen=True)
class Forces:
    """The forces of an assembly."""

    assembly: Assembly

    def parts(self, names: Iterable[str]) -> list[Part]:
        """Derive quantities of `FORCES`, in the groups that are evaluated together.

        Each spring is a group of its own: it shares little with others, and a search in small groups is quick.
        """
        names = tuple(names)
        groups = [(self._body_places, self._body_blocks), (self._scalar_places, self._scalar_blocks)]
        groups += [(self._spring_places(*spring), partial(self._spring_blocks, *spring)) for spring in self._springs]
        parts = []
        for where, blocks in groups:
            outputs = tuple(gathered(name, self._shape(name), blocks(name)) for name in names)
            parts.append(Part(where, outputs))
        return [part for part in parts if any(output.blocks for output in part.outputs)] or parts[:1]

    def inputs(self) -> dict[Any, tuple[str, int]]:
        """Say where the components of angular velocities are read, for bodies in space."""
        if self.assembly.arrays.is_planar:
            return {}
        return {
            symbol: ("velocity", 6 * k + 3 + n)
            for k, body in enumerate(self.assembly.scene.bodies)
            for n, symbol in enumerate(omega(self.assembly.bodies[body.name]))
        }

    @property
    def _alpha_column(self) -> int:
        return self.assembly.arrays.derived * len(self.assembly.scene.bodies)

    def _shape(self, name: str) -> tuple[int, int]:
        size = self._alpha_column + self.assembly.coordinates
        return size, 1 if name == "force" else size

    # --- springs

    @cached_property
    def _springs(self) -> list[tuple[Placed, SpringLaw]]:
        return [self._spring(k, spring) for k, spring in enumerate(self.assembly.scene.springs)]

    def _spring(self, k: int, spring: Spring) -> tuple[Placed, SpringLaw]:
        """A spring stands between its bodies as a joint does."""
        assembly = self.assembly
        numbers = {GROUND: None} | {body.name: n for n, body in enumerate(assembly.scene.bodies)}
        i, j = spring.bodies
        name = f"spring_{k}"
        law = spring_law(spring.stiffness, spring.damping, spring.length, assembly.translations)
        first, second = (Marker(point, IDENTITY) for point in spring.points)
        joint = Joint(name, "spring", (i, j), first, second)
        bodies = (assembly.bodies[i], assembly.bodies[j])
        varying = varying_of(assembly.varying, len(assembly.scene.joints) + k)
        column, arrays = self._alpha_column, assembly.arrays
        ends = Ends(name, bodies, (numbers[i], numbers[j]), 0, 0, column, arrays, varying=varying)
        return Placed(joint, law.form, ends), law

    def _spring_blocks(self, placed: Placed, law: SpringLaw, name: str) -> Iterator[Block]:
        kind = "one" if name == "force" else "displacements"
        return placed.blocks("displacements", kind, law.blocks(name))

    def _spring_places(self, placed: Placed, law: SpringLaw) -> Places:
        translations = self.assembly.translations
        generic = places(law.form, BALL, False, translations)
        own = placed.places(replace(generic, whole=generic.whole | law.whole))
        return merged([own], placed.column_frames(translations))

    # --- bodies

    def _body_blocks(self, name: str) -> Iterator[Block]:
        for k, body in enumerate(self.assembly.scene.bodies):
            yield from self._constant_loads(k, self._load(body), name)

    def _constant_loads(self, number: int, load: ConstantLoad, name: str) -> Iterator[Block]:
        row, normal = self.assembly.arrays.derived * number, normal_symbol(load.identifier)
        pulls = load.pulls(self.assembly.translations)
        for place, turning, loads in ((row, None, pulls), (row + 3, normal, load.moments)):
            for value, change in loads:
                if name == "force":
                    yield Block(place, 0, self._in_motion(value, turning, None))
                elif name == "force_q" and change is not None:
                    yield Block(place, row + 3, self._in_motion(change, turning, normal))

    def _in_motion(self, expression: Any, rows: Any | None, columns: Any | None) -> Any:
        return about_normal(expression, rows, columns) if self.assembly.arrays.is_planar else expression

    def _load(self, body: Body) -> ConstantLoad:
        return ConstantLoad(self.assembly.scene, body, self.assembly.bodies[body.name])

    @property
    def _body_places(self) -> Places:
        assembly = self.assembly
        parts, columns = [], {}
        for k, body in enumerate(assembly.scene.bodies):
            name = assembly.bodies[body.name]
            parts.append(self._places_of(self._load(body)))
            columns[assembly.arrays.derived * k] = name if assembly.translations == "body" else WORLD
            columns[assembly.arrays.derived * k + 3] = name
        return merged(parts, columns)

    def _places_of(self, load: ConstantLoad) -> Places:
        """The frame of one body."""
        arrays, body = self.assembly.arrays, load.identifier
        A = body_symbol("A", body)
        written = arrays.attitude_matrix(body)
        constants = {normal_symbol(body): THIRD_AXIS, **load.points}
        return scalar_places(
            rotations={A: (WORLD, body)},
            given=(A,),
            explicit={} if written is None else {A: written},
            frames=dict.fromkeys(constants, body),
            bodies={WORLD: WORLD, body: body},
            constants=constants,
            stages=load.seen,
            whole=frozenset(load.seen),
            same_axes={(body, 2): (1, WORLD, 2)} if arrays.is_planar else {},
        )

    # --- scalars

    def _scalar_blocks(self, name: str) -> Iterator[Block]:
        for column, load in self._coordinate_loads:
            value = load.value(name)
            if value != 0:
                yield Block(column, 0 if name == "force" else column, value)
        for row, gyroscopic in self._gyroscopics:
            for k in range(3):
                if name == "force" and gyroscopic.moment(k) != 0:
                    yield Block(row + k, 0, gyroscopic.moment(k))
                elif name == "force_v":
                    changes = ((n, gyroscopic.by_omega(k, n)) for n in range(3))
                    yield from (Block(row + k, row + n, change) for n, change in changes if change != 0)

    @cached_property
    def _coordinate_loads(self) -> list[tuple[int, CoordinateLoad]]:
        count = self.assembly.coordinates
        alpha, rate = frames.alpha(count), frames.alpha_dot(count)
        found = []
        for placed in self.assembly.placed:
            if placed.joint.needs_coordinates and not placed.form.coordinates:
                raise InternalError(f"{placed.joint.name} carries a load on a coordinate that its form does not have")
            for k, coordinate in enumerate(placed.joint.coordinates):
                n = placed.ends.first_alpha + k
                if coordinate.is_loaded:
                    found.append((self._alpha_column + n, CoordinateLoad(coordinate, alpha[n], rate[n])))
        return found

    @cached_property
    def _gyroscopics(self) -> list[tuple[int, Gyroscopic]]:
        """None in the plane, where ``omega x J omega`` has no component about the normal."""
        if self.assembly.arrays.is_planar:
            return []
        bodies = ((k, body, self.assembly.bodies[body.name]) for k, body in enumerate(self.assembly.scene.bodies))
        return [(6 * k + 3, Gyroscopic(body, name, omega(name))) for k, body, name in bodies]

    @cached_property
    def _scalar_places(self) -> Places:
        stages = {symbol: value for _, load in self._coordinate_loads for symbol, value in load.stages.items()}
        stages |= {symbol: value for _, moment in self._gyroscopics for symbol, value in moment.stages.items()}
        sums = frozenset(s for s, definition in stages.items() if not isinstance(definition, sympy.Pow))
        return scalar_places(stages=stages, whole=sums)


def omega(body: str) -> tuple[Any, Any, Any]:
    """Components of the angular velocity of a body, body axes, rad/s."""
    x, y, z = sympy.symbols(f"omega_x_of_{body} omega_y_of_{body} omega_z_of_{body}")
    return x, y, z


def scalar_places(**known: Any) -> Places:
    """Places of scalars: all that is not said is nothing."""
    mappings = ("rotations", "explicit", "frames", "stages", "rows", "axis_names", "vector_names")
    nothing: dict[str, Any] = {name: {} for name in mappings}
    return Places(**{"given": (), "bodies": {WORLD: WORLD}, "axes": frozenset(), "columns": (), **nothing, **known})
