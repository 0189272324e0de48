"""What each simplification of a scene saves: its constraints before and after, as programs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import chain

from codegen import models
from codegen.ir.looped import Looped
from codegen.ir.program import Program
from codegen.mechanics.assembly import Assembly
from codegen.mechanics.plan import parts_of
from codegen.parallel import parallel
from codegen.scenes.forms import alone, constraint_quantities
from codegen.scenes.programs import program
from codegen.spec.placement import IDENTITY
from codegen.spec.request import Variant
from codegen.spec.scene import GROUND, ZERO_VECTOR, Body, Joint, Scene
from codegen.spec.sections import attachments, likeness
from flopcount.count import count
from flopcount.counts import Counts


@dataclass(frozen=True, slots=True)
class Item:
    """A line of the bill.

    Attributes:
        words: what was done.
        programs: what evaluates the constraint quantities after it, one after the other.
        additions: by which what several joints give for the same bodies is added up.
    """

    words: str
    programs: tuple[Program, ...]
    additions: int = 0

    @property
    def counts(self) -> Counts:
        """Operations of everything."""
        return sum((count(found) for found in self.programs), Counts(add=self.additions))


@dataclass(frozen=True, slots=True)
class Bill:
    """What a scene saves.

    Attributes:
        items: step by step; empty where no quantity of the constraints is asked for.
        in_plane: operations if the motion were reduced to the plane; None where it is, or where there is no plane.
    """

    items: tuple[Item, ...]
    in_plane: Counts | None = None


def bill(assembly: Assembly, undropped: Assembly, emitted: Program | Looped, has_drives: bool) -> tuple[Item, ...]:
    """Evaluate the constraints of a scene before and after each simplification.

    Args:
        assembly: the scene as it is emitted.
        undropped: the scene with its redundant rows.
        emitted: what is emitted for all constraint quantities at once.
        has_drives: whether it has the rows of drives besides.
    """
    spatial = replace(assembly, scene=replace(assembly.scene, motion="spatial"), dropped=frozenset())
    steps = [("joints evaluated together", spatial)] if len(assembly.scene.joints) > 1 else []
    if assembly.scene.motion == "planar":
        steps.append(("motion in the plane", undropped))
    if undropped.dropped != assembly.dropped:
        steps.append(("redundant rows left out", assembly))
    if has_drives:
        steps.append(("rows of drives added", assembly))
    if isinstance(emitted, Looped):
        steps.append(("equal parts run in loops", assembly))

    joint_by_joint: list[_Step] = [  # in one process: most programs of one are those of another
        ("the library's routine of each joint", spatial, _Each(_in_library)),
        ("geometry folded as constants", spatial, _Each(_folded)),
        ("columns of the ground left out", spatial, _Each(_grounded)),
    ]
    together: list[list[_Step]] = [[(words, step, _together)] for words, step in steps[:-1]]
    found = parallel(_items, [joint_by_joint, *together], lambda _: None)
    return (*chain(*found), *(Item(words, _programs(emitted)) for words, _ in steps[-1:]))


def _programs(emitted: Program | Looped) -> tuple[Program, ...]:
    """What is evaluated, instance by instance."""
    if isinstance(emitted, Program):
        return (emitted,)
    return tuple(loop.program for loop in emitted.loops for _ in range(loop.count))


_Step = tuple[str, Assembly, Callable[[Assembly], tuple[tuple[Program, ...], int]]]
"""Words of an item, the scene, and what evaluates a section of it."""


def _items(steps: list[_Step]) -> list[Item]:
    return [_item(step) for step in steps]


def _together(part: Assembly) -> tuple[tuple[Program, ...], int]:
    return (program(part, constraint_quantities(part.scene)),), 0


def _item(step: _Step) -> Item:
    """Evaluate the sections of a scene; those that differ in numbers only, once."""
    words, assembly, evaluated = step
    known: dict[object, tuple[tuple[Program, ...], int]] = {}
    programs: list[Program] = []
    additions = 0
    for part in parts_of(assembly):
        key = likeness(part.scene), part.dropped, _special(part.scene)
        if key not in known:
            known[key] = evaluated(part)
        programs += known[key][0]
        additions += known[key][1]
    return Item(words, tuple(programs), additions)


def _special(scene: Scene) -> object:
    """The numbers that save operations."""
    numbers = (x for pair in attachments(scene) for point in pair for x in point)
    return tuple(x if x in (-1, 0, 1) else None for x in numbers)


_Evaluate = Callable[[Scene, Joint, Variant], Program]

_MOVING = "the ground, moving"


@dataclass(frozen=True, slots=True)
class _Each:
    """Evaluates joint by joint; equal joints have one program."""

    evaluate: _Evaluate
    known: dict[tuple[object, ...], Program] = field(default_factory=dict)

    def __call__(self, part: Assembly) -> tuple[tuple[Program, ...], int]:
        programs: list[Program] = []
        places: list[tuple[object, ...]] = []
        for joint in part.scene.joints:
            variant, moving = part.forms[joint.name], _moving(part.scene, joint)
            order = tuple(moving.index(name) if name in moving else -1 for name in joint.bodies)
            key = (variant, joint.marker_i, joint.marker_j, joint.pitch, order)
            if key not in self.known:
                self.known[key] = self.evaluate(part.scene, joint, variant)
            programs.append(self.known[key])
            places += _places(self.known[key], joint.bodies if self.evaluate is _in_library else moving)
        return tuple(programs), len(places) - len(set(places))


def _moving(scene: Scene, joint: Joint) -> tuple[str, ...]:
    """The bodies that a joint holds, in the order of the scene."""
    return tuple(body.name for body in scene.bodies if body.name in joint.bodies)


def _in_library(scene: Scene, joint: Joint, variant: Variant) -> Program:
    return models.model(variant).program(constraint_quantities(scene))


def _folded(scene: Scene, joint: Joint, variant: Variant) -> Program:
    """The joint between two bodies that move, the ground being the last of them."""
    moving = Body(_MOVING, Fraction(1), IDENTITY, ZERO_VECTOR, (Fraction(1), *ZERO_VECTOR))
    i, j = (moving.name if name == GROUND else name for name in joint.bodies)
    return _grounded(replace(scene, bodies=(*scene.bodies, moving)), replace(joint, bodies=(i, j)), variant)


def _grounded(scene: Scene, joint: Joint, variant: Variant) -> Program:
    return program(alone(scene, joint, variant), constraint_quantities(scene))


def _places(found: Program, bodies: tuple[str, ...]) -> Iterator[tuple[object, ...]]:
    """Entries that other joints of the same bodies may have too: those over displacements of bodies that move."""
    columns = [(name, k) if name != GROUND else None for name in bodies for k in range(6)]
    for output in found.outputs:
        if output.name in ("phi_q_t_lambda_q", "phi_q_t_lambda"):
            places = columns + [None] * (output.sparsity.nrow - len(columns))
            for row, column in output.sparsity.entries():
                entry = (output.name, places[row], places[column] if output.sparsity.ncol > 1 else 0)
                if None not in entry:
                    yield entry
