"""A kinematic chain as data: a tree of links, the cuts that close its loops, its end effectors (S2).

Numbers are exact: the decimal that stands in the file; multiples of pi are kept to 50 digits. Lengths in m, angles in
rad, masses in kg, times in s. A frame is placed on a link by the six constants of S2 Table 1,
``T = Screw(z, psi, c) Screw(x, alpha, a) Screw(z, theta, d)``.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from codegen.spec.chain_forces import Condition, EffectorForce, JointForce, Spring, Stop, WorldForce
from codegen.spec.chain_motions import Independent
from codegen.spec.scene import Matrix, Vector

BASE = "base"
"""Name of link 0."""

JOINT_TYPES = ("revolute", "prismatic", "screw")

BASES = ("fixed", "moving")
"""Whether pose, velocity and acceleration of link 0 are inputs of the routines."""

BASE_COORDINATES = ("base x", "base y", "base z", "base roll", "base pitch", "base yaw")
"""Coordinates of a moving base in a run: its origin in m, and turns about x, the new y and the newest z in rad."""

CHAIN_QUANTITIES = (
    "frames",
    "closure",
    "phi",
    "phi_q",
    "J",
    "gamma_R",
    "M",
    "f_C",
    "f_G",
    "D_E",
    "effectors",
    "wrenches",
    "tau_A",
    "f_A",
)
"""What a chain may ask for; `docs/chain.md` says what each is."""

CLOSURE_QUANTITIES = ("closure", "phi", "phi_q", "J", "gamma_R")
"""Those that only chains with cuts have."""

EFFECTOR_QUANTITIES = ("D_E", "effectors")
"""Those that only chains with end effectors have."""

JOINT_FORCE_QUANTITIES = ("tau_A",)
"""Those that only chains with forces or stops on coordinates have."""

EFFECTOR_FORCE_QUANTITIES = ("f_A",)
"""Those that only chains with forces at end effectors, or springs between them, have."""

MASS_QUANTITIES = ("M", "f_C", "f_G", "wrenches")
"""Those that need masses."""


@dataclass(frozen=True, slots=True)
class Row:
    """A row of the extended Denavit-Hartenberg table, from a link's frame i to a frame ij hung on it.

    Attributes:
        psi: rad, about z_i, from x_i to the common normal of z_i and z_ij.
        c: m, along z_i.
        alpha: rad, about the common normal, from z_i to z_ij.
        a: m, along the common normal.
        theta: rad, about z_ij, from the common normal to x_ij; of a revolute joint or screw the coordinate at t = 0.
        d: m, along z_ij; of a prismatic joint the coordinate at t = 0.
    """

    psi: Fraction = Fraction(0)
    c: Fraction = Fraction(0)
    alpha: Fraction = Fraction(0)
    a: Fraction = Fraction(0)
    theta: Fraction = Fraction(0)
    d: Fraction = Fraction(0)


@dataclass(frozen=True, slots=True)
class Link:
    """A link with its inner joint, which has the link's name.

    Attributes:
        name: unique, not ``base``.
        parent: name of the link nearer the base, or ``base``.
        type: one of `JOINT_TYPES`.
        row: where its frame stands on the parent.
        mass: kg; 0 for a massless link.
        centre: [3] m, of mass, from the origin of the link's frame, its axes.
        inertia: [3, 3] kg m^2 about the centre of mass, link axes.
        prefer: value from which the coordinate is sought at t = 0 instead of that in the row, if it is dependent:
            selects the branch on which the loops are closed.
        pitch: of a screw, m/rad: its coordinate is theta, and ``d`` of the row belongs to ``theta`` of the row.
        rotor: kg m^2, of a prismatic joint kg: inertia of a drive, times the square of its gear ratio.
    """

    name: str
    parent: str
    type: str
    row: Row
    mass: Fraction
    centre: Vector
    inertia: Matrix
    prefer: Fraction | None = None
    pitch: Fraction = Fraction(0)
    rotor: Fraction = Fraction(0)

    @property
    def coordinate(self) -> Fraction:
        """The joint coordinate at t = 0 as the row has it."""
        return self.row.d if self.type == "prismatic" else self.row.theta

    @property
    def unit(self) -> str:
        """Unit of the coordinate."""
        return "m" if self.type == "prismatic" else "rad"


@dataclass(frozen=True, slots=True)
class Frame:
    """A frame fixed on a link, or on the base."""

    link: str
    row: Row


@dataclass(frozen=True, slots=True)
class Cut:
    """A link that was cut: its two frames coincide in every pose of the mechanism.

    Attributes:
        name: unique among the cuts.
        base: frame C, on the side nearer the base.
        far: frame R.
    """

    name: str
    base: Frame
    far: Frame


@dataclass(frozen=True, slots=True)
class Effector:
    """An end effector.

    Attributes:
        name: unique among the effectors.
        frame: frame E.
        force: [3] N, constant, on the chain, axes of E.
        moment: [3] N m about the origin of E, likewise.
    """

    name: str
    frame: Frame
    force: Vector
    moment: Vector


@dataclass(frozen=True, slots=True)
class Chain:
    """A complex kinematic chain.

    Attributes:
        name: of the routines; a C identifier.
        gravity: [3] m/s^2, axes of frame 0; of the world where the base moves.
        links: parents before children.
        cuts: one for each loop.
        effectors: end effectors.
        independents: independent coordinates; all of them, in the order of the links, where there are no cuts and the
            file names none.
        joint_forces: on coordinates.
        effector_forces: at effectors.
        base: one of `BASES`.
        assemble: whether the coordinates in the rows are guesses, from which cuts that are open are to be closed.
        quantities: of `CHAIN_QUANTITIES`; empty for all that the chain has.
        base_independents: `BASE_COORDINATES` of a moving base, as far as they are named; the others rest at 0.
        world_forces: at effectors, in axes that do not turn with them.
        springs: between effectors.
        stops: of coordinates.
    """

    name: str
    gravity: Vector
    links: tuple[Link, ...]
    cuts: tuple[Cut, ...] = ()
    effectors: tuple[Effector, ...] = ()
    independents: tuple[Independent, ...] = ()
    joint_forces: tuple[JointForce, ...] = ()
    effector_forces: tuple[EffectorForce, ...] = ()
    base: str = "fixed"
    assemble: bool = False
    quantities: tuple[str, ...] = ()
    base_independents: tuple[Independent, ...] = ()
    world_forces: tuple[WorldForce, ...] = ()
    springs: tuple[Spring, ...] = ()
    stops: tuple[Stop, ...] = ()

    @property
    def wanted(self) -> tuple[str, ...]:
        """What is generated, in the order of `CHAIN_QUANTITIES`."""
        missing: tuple[str, ...] = () if self.cuts else CLOSURE_QUANTITIES
        missing += () if self.effectors else EFFECTOR_QUANTITIES
        missing += () if self.acts_on_joints else JOINT_FORCE_QUANTITIES
        missing += () if self.acts_at_effectors else EFFECTOR_FORCE_QUANTITIES
        missing += () if any(link.mass or any(map(any, link.inertia)) for link in self.links) else MASS_QUANTITIES
        asked = self.quantities or CHAIN_QUANTITIES
        return tuple(name for name in CHAIN_QUANTITIES if name in asked and name not in missing)

    @property
    def acts_on_joints(self) -> bool:
        """Whether forces act on coordinates at all times, or stops do."""
        return bool(self.stops) or any(force.when is None for force in self.joint_forces)

    @property
    def acts_at_effectors(self) -> bool:
        """Whether forces act at effectors at all times, or springs do."""
        own = any(any((*effector.force, *effector.moment)) for effector in self.effectors)
        return own or bool(self.springs) or any(when is None for when in self._at_effectors)

    @property
    def conditions(self) -> tuple[Condition, ...]:
        """When the forces that switch act: those on coordinates, those at effectors, those in axes of the world."""
        found = (*(force.when for force in self.joint_forces), *self._at_effectors)
        return tuple(when for when in found if when is not None)

    @property
    def _at_effectors(self) -> list[Condition | None]:
        """When the forces at effectors act."""
        own = [force.when for force in self.effector_forces]
        return own + [force.when for force in self.world_forces]

    def index(self, name: str) -> int:
        """Place of a link's coordinate in q.

        Raises:
            KeyError: there is no such link.
        """
        for k, link in enumerate(self.links):
            if link.name == name:
                return k
        raise KeyError(name)
