"""A scene as data: bodies, joints and forces of one mechanism, as `codegen.spec.scene_file` reads them.

Numbers are exact: the decimal that stands in the file, or what follows from it in rational arithmetic. Directions that
need a square root are kept to 40 digits. Lengths in m, masses in kg, angles in rad, times in s.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from fractions import Fraction

Vector = tuple[Fraction, Fraction, Fraction]
"""Three components."""

Matrix = tuple[Vector, Vector, Vector]
"""Three rows."""

Quaternion = tuple[Fraction, Fraction, Fraction, Fraction]
"""w, x, y, z; body to world."""

GROUND = "ground"
"""Name of the body that does not move; its axes are those of the world."""

SCENE_JOINTS = ("revolute", "translational", "screw", "cylindrical", "universal", "planar", "ball", "rigid")
"""Joint types of a scene file."""

COORDINATE_UNITS = {
    "revolute": ("rad",),
    "translational": ("m",),
    "screw": ("rad",),
    "cylindrical": ("m", "rad"),
    "universal": ("rad", "rad"),
    "planar": ("m", "m", "rad"),
    "ball": ("rad", "rad", "rad"),
    "rigid": (),
}
"""Units of the coordinates of each joint type, one for each degree of freedom; translations first."""

SCENE_FORMS = ("auto", "conventional", "parametric", "relative")
"""Forms of a joint in a scene file."""

SCENE_QUANTITIES = (
    "phi",
    "phi_q",
    "phi_q_t_lambda_q",
    "gamma",
    "phi_q_v",
    "phi_q_t_lambda",
    "branch",
    "orthonormalise",
    "check_orthonormal",
    "mass",
    "force",
    "residual",
)
"""What a scene may ask for. ``branch``, ``orthonormalise`` and ``check_orthonormal`` are emitted only if named.
``force`` is the right-hand side of ``M a + phi_q^T lambda = force``; ``residual`` is that of an implicit integrator,
with its Jacobian."""

KINEMATIC_QUANTITIES = SCENE_QUANTITIES[:9]
"""Those that need no mass."""

MOTIONS = ("spatial", "planar")
"""Motions of a scene."""

ZERO_VECTOR: Vector = (Fraction(0), Fraction(0), Fraction(0))


@dataclass(frozen=True, slots=True)
class Body:
    """A rigid body.

    Attributes:
        name: unique, not ``ground``.
        mass: kg; 0 where only kinematic quantities are asked for and the file names none.
        inertia: [3, 3] kg m^2 about the centre of mass, body axes; 0 where the file names none, as for the mass.
        position: [3] m, centre of mass at t = 0, world.
        quaternion: attitude at t = 0, of norm 1 within 1e-9.
        velocity: [3] m/s at t = 0, world.
        angular_velocity: [3] rad/s at t = 0, body axes.
    """

    name: str
    mass: Fraction
    inertia: Matrix
    position: Vector
    quaternion: Quaternion
    velocity: Vector = ZERO_VECTOR
    angular_velocity: Vector = ZERO_VECTOR


@dataclass(frozen=True, slots=True)
class Marker:
    """A joint frame on a body: ``s`` and ``C`` of S1.

    Attributes:
        point: [3] m, from the centre of mass, body axes; on the ground from the origin, world axes.
        axes: [3, 3] ``C = [f g h]``, the axes of the joint are its columns; orthonormal to 40 digits.
    """

    point: Vector
    axes: Matrix


@dataclass(frozen=True, slots=True)
class Drive:
    """A prescribed motion of a joint coordinate: ``position + speed t + amplitude sin(frequency t + phase)``.

    Attributes:
        position: m or rad.
        speed: m/s or rad/s.
        amplitude: m or rad.
        frequency: rad/s.
        phase: rad.
    """

    position: Fraction
    speed: Fraction
    amplitude: Fraction = Fraction(0)
    frequency: Fraction = Fraction(0)
    phase: Fraction = Fraction(0)

    def value(self, t: float) -> float:
        """The coordinate at a time, m or rad."""
        swing = float(self.amplitude) * math.sin(self._angle(t)) if self.amplitude else 0.0
        return float(self.position) + float(self.speed) * t + swing

    def rate(self, t: float) -> float:
        """Its rate, m/s or rad/s."""
        swing = float(self.amplitude * self.frequency) * math.cos(self._angle(t)) if self.amplitude else 0.0
        return float(self.speed) + swing

    def _angle(self, t: float) -> float:
        return float(self.frequency) * t + float(self.phase)


@dataclass(frozen=True, slots=True)
class Limit:
    """Soft stops of a joint coordinate: a spring and damper act beyond ``lower`` and ``upper`` (m or rad)."""

    lower: Fraction | None
    upper: Fraction | None
    stiffness: Fraction
    damping: Fraction


@dataclass(frozen=True, slots=True)
class Coordinate:
    """What acts on one coordinate of a joint; the coordinate is 0 at t = 0 where the joint is given by world vectors.

    Attributes:
        torque: constant generalised force, N or N m.
        stiffness: N/m or N m/rad.
        damping: N s/m or N m s/rad.
        rest: value of the coordinate at which the spring is free, m or rad.
        drive: prescribed motion.
        limit: soft stops.
    """

    torque: Fraction = Fraction(0)
    stiffness: Fraction = Fraction(0)
    damping: Fraction = Fraction(0)
    rest: Fraction = Fraction(0)
    drive: Drive | None = None
    limit: Limit | None = None

    @property
    def is_loaded(self) -> bool:
        """Whether something acts on the coordinate, so that the joint needs it."""
        return self != Coordinate()


@dataclass(frozen=True, slots=True)
class Joint:
    """A joint between two bodies.

    Attributes:
        name: unique.
        type: one of `SCENE_JOINTS`.
        bodies: names of body i and body j; either may be the ground.
        marker_i: joint frame on body i.
        marker_j: joint frame on body j, equal to that on body i where all coordinates are 0; ``h`` is the axis of the
            joint. The axes of a universal joint's cross are ``h_i`` and ``f_j``.
        pitch: of a screw, m/rad; 0 otherwise.
        form: one of `SCENE_FORMS`.
        coordinates: one for each degree of freedom, translations first, as in the parametric form.
    """

    name: str
    type: str
    bodies: tuple[str, str]
    marker_i: Marker
    marker_j: Marker
    pitch: Fraction = Fraction(0)
    form: str = "auto"
    coordinates: tuple[Coordinate, ...] = ()

    @property
    def needs_coordinates(self) -> bool:
        """Whether something acts on a coordinate of the joint."""
        return any(coordinate.is_loaded for coordinate in self.coordinates)


@dataclass(frozen=True, slots=True)
class Spring:
    """A spring and damper between two points.

    Attributes:
        bodies: names; either may be the ground.
        points: [3] m each, from the centre of mass, body axes; on the ground world.
        stiffness: N/m.
        damping: N s/m.
        length: m, at which the spring is free.
    """

    bodies: tuple[str, str]
    points: tuple[Vector, Vector]
    stiffness: Fraction
    damping: Fraction
    length: Fraction


@dataclass(frozen=True, slots=True)
class Torque:
    """A constant torque on a body, [3] N m, world axes."""

    body: str
    vector: Vector


@dataclass(frozen=True, slots=True)
class Force:
    """A constant force at a point of a body.

    Attributes:
        body: name, not the ground.
        vector: [3] N, world axes.
        point: [3] m, from the centre of mass, body axes.
    """

    body: str
    vector: Vector
    point: Vector = ZERO_VECTOR


@dataclass(frozen=True, slots=True)
class Wanted:
    """What is generated of a scene.

    Attributes:
        quantities: of `SCENE_QUANTITIES`; empty for what `codegen.scenes.generate.wanted` says.
        rows: of the parametric joints, ``regular`` or ``table4``.
        derivative: of the parametric joints, ``exact`` or ``substituted``.
        point: axes of rows of the parametric joints, see `codegen.spec.request.Variant`; not read from files.
    """

    quantities: tuple[str, ...] = ()
    rows: str = "regular"
    derivative: str = "exact"
    point: str = "body"


@dataclass(frozen=True, slots=True)
class Scene:
    """A mechanism.

    Attributes:
        name: of the routines; a C identifier.
        gravity: [3] m/s^2, world.
        bodies: in the order of the file; the ground is not among them.
        joints: in the order of the file.
        springs: between points.
        torques: on bodies.
        motion: one of `MOTIONS`.
        wanted: what is generated.
        assemble: whether the pose at t = 0 is a guess, from which joints that do not close are to be closed.
        forces: at points of bodies.
    """

    name: str
    gravity: Vector
    bodies: tuple[Body, ...]
    joints: tuple[Joint, ...]
    springs: tuple[Spring, ...] = ()
    torques: tuple[Torque, ...] = ()
    motion: str = "spatial"
    wanted: Wanted = field(default_factory=Wanted)
    assemble: bool = False
    forces: tuple[Force, ...] = ()

    def body(self, name: str) -> Body | None:
        """Find a body; None for the ground."""
        return next((body for body in self.bodies if body.name == name), None)
