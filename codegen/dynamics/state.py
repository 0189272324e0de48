"""The state vector as values of a program under construction, and the arguments of a system's programs from them."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

from codegen.dynamics.attitude import plane_rotation, rate_map, rotation, scaled_parameters
from codegen.dynamics.layout import Layout, whole
from codegen.dynamics.matrices import Matrices, moved, transposed
from codegen.errors import InternalError
from codegen.ir.builder import Builder
from codegen.ir.inline import Entries, inline
from codegen.ir.program import Program
from codegen.mechanics.system import System

Values = list[int]


class State:
    """Values of the state of a system.

    Places are those of all entries; what the state leaves out is told by `know`.

    Args:
        system: the mechanism.
        layout: of the state.

    Attributes:
        builder: where everything is computed.
        matrices: arithmetic over it.
        given: layout of the state.
        layout: of all entries.
        inverse: ``P^-1`` of `codegen.mechanics.condensed`, for what is left out.
    """

    def __init__(self, system: System, layout: Layout) -> None:
        self.builder = Builder()
        self.matrices = Matrices(self.builder)
        self.system = system
        self.given = layout
        self.layout = whole(system, layout)
        self._places = {place: k for k, place in enumerate(layout.places)}
        self.inverse: Entries = {}
        self._known: dict[int, int] = {}
        self.arrays = system.assembly.arrays
        self.bodies = range(len(system.assembly.scene.bodies))
        self.size = len(system.assembly.columns)

    # --- entries of y

    @property
    def is_planar(self) -> bool:
        """Whether the bodies move in the plane."""
        return self.arrays.is_planar

    @property
    def in_body_axes(self) -> bool:
        """Whether the virtual translations of the system's programs are in body axes."""
        return self.system.assembly.translations == "body"

    @property
    def axes(self) -> int:
        """Components of a position."""
        return 2 if self.is_planar else 3

    @property
    def stride(self) -> int:
        """Entries of a body among the positions."""
        return 3 if self.is_planar else 7

    def y(self, places: range) -> Values:
        """Entries of ``y``; of those that are left out what they follow to be, 0 while that is not known."""
        zero = self.builder.constant(0)
        return [
            self.builder.input("y", self._places[k]) if k in self._places else self._known.get(k, zero) for k in places
        ]

    def rates(self, places: range) -> Values:
        """Entries of ``ydot``; what is left out has no inertia."""
        zero = self.builder.constant(0)
        return [self.builder.input("ydot", self._places[k]) if k in self._places else zero for k in places]

    def know(self, place: int, value: int) -> None:
        """Say what an entry is that the state leaves out."""
        self._known[place] = value

    def attitude_places(self, body: int) -> range:
        """Places of the Euler parameters, or of the angle, of a body."""
        return range(self.stride * body + self.axes, self.stride * (body + 1))

    @property
    def alpha_places(self) -> range:
        """Places of the joint coordinates."""
        return self.layout.coordinates

    @cached_property
    def attitudes(self) -> list[Entries]:
        """``A`` of each body."""
        found = []
        for body in self.bodies:
            p = self.y(self.attitude_places(body))
            if self.is_planar:
                found.append(plane_rotation(self.builder, p[0]))
            else:
                found.append(rotation(self.builder, p, self._scaled[body]))
        return found

    @cached_property
    def _scaled(self) -> list[Values]:
        return [scaled_parameters(self.builder, self.y(self.attitude_places(body))) for body in self.bodies]

    # --- displacements

    @cached_property
    def displacements(self) -> Entries:
        """What the displacements of the programs are of the change of the positions in ``y``."""
        one = self.builder.constant(1)
        found: Entries = {}
        for body in self.bodies:
            row, column = self.arrays.displacements * body, self.stride * body
            translation = {(k, k): one for k in range(self.axes)}
            found |= moved(transposed(self.attitudes[body]) if self.in_body_axes else translation, row, column)
            turn = {(0, 0): one} if self.is_planar else rate_map(self.builder, self._scaled[body])
            found |= moved(turn, row + self.axes, column + self.axes)
        first = self.arrays.displacements * len(self.bodies)
        return found | {(first + k, place): one for k, place in enumerate(self.alpha_places)}

    @cached_property
    def axes_of_velocity(self) -> Entries:
        """What velocities as the programs have them are of those in ``y``: ``A^T v`` in body axes."""
        one = self.builder.constant(1)
        found = {(k, k): one for k in range(self.size)}
        for body in self.bodies if self.in_body_axes else ():
            first = self.arrays.displacements * body
            for k in range(self.axes):
                del found[first + k, first + k]
            found |= moved(transposed(self.attitudes[body]), first, first)
        return found

    def in_program_axes(self, velocity: Values) -> Values:
        """Turn velocities or accelerations to the axes that the programs have."""
        if not self.in_body_axes:
            return velocity
        found = self.matrices.product(self.axes_of_velocity, {(k, 0): value for k, value in enumerate(velocity)})
        return [found[k, 0] for k in range(self.size)]

    def turning(self, velocity: Values) -> Entries:
        """Derivative of `in_program_axes` by the displacements: ``(A^T v)~`` by the rotation.

        Args:
            velocity: in the axes that the programs have.
        """
        found: Entries = {}
        for body in self.bodies if self.in_body_axes else ():
            first = self.arrays.displacements * body
            if self.is_planar:
                x, y = velocity[first : first + 2]
                negative = self.matrices.negative({(1, 0): x})
                found |= moved({(0, 0): y} | negative, first, first + 2)
            else:
                found |= moved(self.matrices.skew(velocity[first : first + 3]), first, first + 3)
        return found

    # --- programs

    @cached_property
    def velocity(self) -> Values:
        """Velocities, in the axes that the programs have."""
        return self.in_program_axes(self.y(self.layout.velocities))

    @cached_property
    def acceleration(self) -> Values:
        """Classical accelerations, in the axes that the programs have."""
        return self.in_program_axes(self.rates(self.layout.velocities))

    def evaluated(
        self, program: Program, velocity: Values | None = None, multipliers: Values | None = None
    ) -> dict[str, Entries]:
        """Evaluate a program of the system at the state.

        Args:
            program: of a `System`.
            velocity: in place of the velocities of the state.
            multipliers: in place of its ``lambda``.
        """
        return inline(self.builder, program, self._reader(velocity, multipliers))

    def _reader(self, velocity: Values | None, multipliers: Values | None) -> Callable[[str, int], int]:
        velocities = self.velocity if velocity is None else velocity
        forces = self.y(self.layout.multipliers) if multipliers is None else multipliers

        def read(argument: str, index: int) -> int:
            match argument:
                case "r":
                    body, k = divmod(index, self.arrays.position)
                    return self.builder.input("y", self.stride * body + k)
                case "A":
                    body, place = divmod(index, self.arrays.attitude)
                    column, row = divmod(place, self.axes)
                    return self.attitudes[body][row, column]
                case "alpha":
                    return self.builder.input("y", self.alpha_places[index])
                case "velocity":
                    return velocities[index]
                case "lambda":
                    return forces[index]
                case "t" | "revolutions" | "geometry":
                    return self.builder.input(argument, index)
            raise InternalError(f"no entry of the state for {argument}")

        return read
