"""A scene as one system of constraints: the rows of its joints over the displacements of its bodies.

Every joint is formulated as in the library, between bodies i and j, and then written for its own two bodies
(`codegen.mechanics.placed`). Blocks of several joints at one place are added up before anything is evaluated.

Generalised displacements: ``delta r`` and ``delta pi`` (body axes) of each body in the order of the scene, then the
coordinates alpha of the joints in parametric form. Translations are in world axes, or in body axes where a derivative
is substituted, since S1 substitutes in these coordinates; not so where points are held together in world axes.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache, cached_property
from typing import Any

from codegen.ir.lower import Block, Part, SymbolicOutput
from codegen.ir.program import Argument
from codegen.mechanics import frames
from codegen.mechanics.arrays import PLANAR, SPATIAL, Arrays
from codegen.mechanics.blocks import gathered
from codegen.mechanics.derivation import AS_IT_STANDS, Derivation
from codegen.mechanics.formulation import Formulation, formulation
from codegen.mechanics.joints import JOINTS
from codegen.mechanics.merged import merged
from codegen.mechanics.placed import Ends, Placed, geometry_symbol
from codegen.mechanics.places import WORLD, places
from codegen.spec.identifiers import identifiers
from codegen.spec.request import Variant
from codegen.spec.scene import GROUND, Scene
from codegen.spec.sections import Coordinate, varying_of

KINDS = {
    "phi": ("constraints", "one"),
    "phi_q": ("constraints", "displacements"),
    "phi_q_t_lambda_q": ("displacements", "displacements"),
    "gamma": ("constraints", "one"),
    "phi_q_v": ("constraints", "one"),
    "phi_q_v_q": ("constraints", "displacements"),
    "phi_q_t_lambda": ("displacements", "one"),
    "branch": ("joints", "one"),
}
"""What the rows and columns of a quantity are."""


@cache
def _derived(variant: Variant, translations: str, piece: str = "whole") -> tuple[Formulation, Derivation]:
    """A joint between bodies i and j, or a piece of it as `Placed` has them, once for all scenes."""
    if piece == "point":
        return _derived(Variant("ball", "conventional", None), translations)
    form = formulation(JOINTS[variant.joint], variant, translations)
    form = replace(form, rows=form.rows[1:]) if piece == "turn" else form
    return form, Derivation(form)


@dataclass(frozen=True)
class Assembly:
    """A scene whose joints have their forms.

    Attributes:
        scene: the mechanism; in planar motion one that lies in the plane of world x and y, see
            `codegen.spec.plane.flattened`.
        forms: joint name -> form, rows and derivative.
        dropped: rows of the joints that are left out.
        varying: coordinates of attachments that are read at run time -> number in the argument ``geometry``.
    """

    scene: Scene
    forms: Mapping[str, Variant]
    dropped: frozenset[int] = frozenset()
    varying: Mapping[Coordinate, int] = field(default_factory=dict)

    @cached_property
    def arrays(self) -> Arrays:
        """Layout of the bodies in the arrays."""
        return PLANAR if self.scene.motion == "planar" else SPATIAL

    @cached_property
    def translations(self) -> str:
        """Axes of the virtual translations."""
        in_body = (v.derivative == "substituted" and v.point == "body" for v in self.forms.values())
        return "body" if any(in_body) else "world"

    @cached_property
    def bodies(self) -> dict[str, str]:
        """Identifiers of the bodies, and of the ground."""
        return {GROUND: WORLD} | identifiers((body.name for body in self.scene.bodies), reserved=(WORLD,))

    @cached_property
    def placed(self) -> tuple[Placed, ...]:
        """The joints with their rows and columns."""
        numbers = {GROUND: None} | {body.name: k for k, body in enumerate(self.scene.bodies)}
        names = identifiers(joint.name for joint in self.scene.joints)
        found, row, alpha = [], 0, 0
        for number, joint in enumerate(self.scene.joints):
            form, _ = _derived(self.forms[joint.name], self.translations)
            i, j = joint.bodies
            ends = Ends(
                names[joint.name],
                (self.bodies[i], self.bodies[j]),
                (numbers[i], numbers[j]),
                row,
                alpha,
                self.arrays.derived * len(self.scene.bodies),
                self.arrays,
                self.dropped,
                varying_of(self.varying, number),
                number,
            )
            found.append(Placed(joint, form, ends))
            row += form.row_count
            alpha += form.coordinates
        return tuple(found)

    @cached_property
    def all_rows(self) -> int:
        """Rows of all joints."""
        return sum(placed.form.row_count for placed in self.placed)

    @cached_property
    def rows(self) -> tuple[int, ...]:
        """The rows that the system has, among those of all joints."""
        return tuple(row for row in range(self.all_rows) if row not in self.dropped)

    @cached_property
    def coordinates(self) -> int:
        """Joint coordinates of all joints in parametric form."""
        return sum(placed.form.coordinates for placed in self.placed)

    @cached_property
    def columns(self) -> tuple[int, ...]:
        """The displacements that the system has, among those that are derived."""
        arrays, bodies = self.arrays, len(self.scene.bodies)
        moving = [arrays.derived * body + k for body in range(bodies) for k in arrays.kept]
        first = arrays.derived * bodies
        return (*moving, *range(first, first + self.coordinates))

    # --- arguments

    def arguments(self) -> tuple[Argument, ...]:
        """Arrays of the signature: positions, attitudes, joint coordinates, velocities, multipliers."""
        bodies = len(self.scene.bodies)
        return (
            Argument("r", (self.arrays.position * bodies, 1)),
            Argument("A", (self.arrays.attitude * bodies, 1)),
            Argument("alpha", (self.coordinates, 1)),
            Argument("revolutions", (self.counted, 1)),
            Argument("geometry", (1 + max(self.varying.values(), default=-1), 1)),
            Argument("velocity", (len(self.columns), 1)),
            Argument("lambda", (len(self.rows), 1)),
        )

    @property
    def counted(self) -> int:
        """Number of joints whose whole turns are an input."""
        return len(self._counting)

    @cached_property
    def _counting(self) -> list[Placed]:
        """Joints whose whole turns are an input: conventional screws."""
        return [p for p in self.placed if p.joint.type == "screw" and not p.form.coordinates]

    def inputs(self) -> dict[Any, tuple[str, int]]:
        """Say for each symbol which argument it is read from, and at which offset."""
        found: dict[Any, tuple[str, int]] = {}
        for k, body in enumerate(self.scene.bodies):
            found |= self.arrays.inputs(self.bodies[body.name], k)
        count = self.coordinates
        found |= {symbol: ("alpha", k) for k, symbol in enumerate(frames.alpha(count))}
        first = self.arrays.displacements * len(self.scene.bodies)
        found |= {symbol: ("velocity", first + k) for k, symbol in enumerate(frames.alpha_dot(count))}
        multipliers = frames.multipliers(self.all_rows)
        found |= {multipliers[row]: ("lambda", k) for k, row in enumerate(self.rows)}
        turns = [placed.symbols[frames.revolutions] for placed in self._counting]
        found |= {symbol: ("revolutions", k) for k, symbol in enumerate(turns)}
        return found | {geometry_symbol(k): ("geometry", k) for k in self.varying.values()}

    # --- outputs

    def parts(self, names: Iterable[str]) -> list[Part]:
        """Derive quantities of the constraints, in the groups that are evaluated together.

        Joints whose frames are axes of their bodies are evaluated together where they hang together: they share
        vectors. Any other joint is a group of its own, since it shares little but its joint frames; two where its
        derivative is substituted, because ``phi`` and ``branch`` never are, nor are rows of points in world axes.
        """
        names = tuple(names)
        sharing = [p for p in self.placed if not (p.form.coordinates or self._is_substituted(p) or p.has_own_frames)]
        groups = [(group, names, False) for group in connected(sharing)]
        substituted = [placed for placed in self.placed if self._is_substituted(placed)]
        groups.append((substituted, tuple(name for name in names if name in AS_IT_STANDS), False))
        derived = tuple(name for name in names if name not in AS_IT_STANDS)
        pieces = [self._pieces(placed) for placed in substituted]
        points = [point for point, _ in pieces if point is not None]
        groups += [(group, derived, False) for group in connected(points)]
        groups += [([turn], derived, True) for _, turn in pieces]
        groups += [([placed], names, False) for placed in self.placed if placed not in (*sharing, *substituted)]
        return [self._part(*group) for group in groups if group[0] and group[1]]

    def _pieces(self, placed: Placed) -> tuple[Placed | None, Placed]:
        """Rows that no joint relation is inserted into, those of points in world axes, and the others."""
        variant = self.forms[placed.joint.name]
        if variant.point == "body" or JOINTS[placed.joint.type].translations:
            return None, placed
        point, turn = (_derived(variant, self.translations, piece)[0] for piece in ("point", "turn"))
        behind = replace(placed.ends, first_row=placed.ends.first_row + point.row_count)
        return Placed(placed.joint, point, placed.ends, "point"), Placed(placed.joint, turn, behind, "turn")

    def _is_substituted(self, placed: Placed) -> bool:
        variant = self.forms[placed.joint.name]
        return variant.form == "parametric" and variant.derivative == "substituted"

    def _part(self, placed: Sequence[Placed], names: Iterable[str], is_substituted: bool) -> Part:
        outputs = tuple(self._quantity(name, placed) for name in names)
        parts = [p.places(places(p.form, self.forms[p.joint.name], is_substituted, self.translations)) for p in placed]
        columns = {column: frame for p in placed for column, frame in p.column_frames(self.translations).items()}
        return Part(merged(parts, columns), outputs)

    def selection(self, name: str) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """The rows and columns of a derived quantity that the system has."""
        joints = tuple(range(len(self.placed)))
        chosen = {"constraints": self.rows, "displacements": self.columns, "joints": joints, "one": (0,)}
        rows, columns = KINDS[name]
        return chosen[rows], chosen[columns]

    def jacobian_blocks(self, placed: Placed) -> tuple[Block, ...]:
        """``phi_q`` of a joint between bodies i and j."""
        return _derived(self.forms[placed.joint.name], self.translations)[1].quantity("phi_q").blocks

    def _quantity(self, name: str, joints: Sequence[Placed]) -> SymbolicOutput:
        rows, columns = KINDS[name]
        derived = self.arrays.derived * len(self.scene.bodies) + self.coordinates
        sizes = {"constraints": self.all_rows, "displacements": derived, "joints": len(self.placed), "one": 1}
        blocks: list[Block] = []
        for placed in joints:
            _, derivation = _derived(self.forms[placed.joint.name], self.translations, placed.piece)
            blocks += placed.blocks(rows, columns, derivation.quantity(name).blocks)
        return gathered(name, (sizes[rows], sizes[columns]), blocks)


_LARGEST_GROUP = 12
"""Joints that are evaluated together at most."""


def connected(joints: Sequence[Placed]) -> list[list[Placed]]:
    """Part joints into those that a moving body leads from one to the other, in order; large groups are cut."""
    groups: list[tuple[set[int], list[Placed]]] = []
    for placed in joints:
        bodies = {number for number in placed.ends.numbers if number is not None}
        near = [group for group in groups if group[0] & bodies]
        groups = [group for group in groups if group not in near]
        groups.append((bodies.union(*(group[0] for group in near)), [p for group in near for p in group[1]] + [placed]))
    ordered = [sorted(group, key=lambda placed: placed.ends.first_row) for _, group in groups]
    ordered.sort(key=lambda group: group[0].ends.first_row)
    size = _LARGEST_GROUP
    return [group[k : k + size] for group in ordered for k in range(0, len(group), size)]
