"""What is to be measured: routines of joints, or of a scene."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Protocol

from codegen import build
from codegen.cache import kept
from codegen.dynamics.layout import layout
from codegen.emit.routine import Routine
from codegen.errors import InternalError, Mistake, SpecificationError, nearest
from codegen.ir.looped import Looped
from codegen.ir.program import Program
from codegen.measure.constraints import Pose
from codegen.measure.pose_domain import PoseDomain
from codegen.measure.routine_builds import Build
from codegen.mechanics.assembly import Assembly
from codegen.mechanics.plan import plan
from codegen.mechanics.system import System
from codegen.scenes.compose import compose
from codegen.scenes.generate import judge, row_names
from codegen.scenes.loops import decided
from codegen.scenes.programs import program
from codegen.spec.plane import flattened
from codegen.spec.request import OUTPUTS, QUANTITIES, Options, Variant
from codegen.spec.scene import Scene
from codegen.trade.builds import builds
from codegen.trade.programs import routines
from codegen.trade.specimens import SampledScene
from flopcount.count import count

SAMPLES = 4096
SCENE_FORMS = ("", "conventional", "parametric")
"""Forms of a scene's joints that are tried; the first is the scene's own choice."""


@dataclass(frozen=True, slots=True)
class Case:
    """A routine to be measured.

    Attributes:
        group: whose candidates are timed in turn: a joint or a scene.
        name: for the progress.
        routine: makes it.
    """

    group: str
    name: str
    routine: Callable[[], Routine]


class Request(Protocol):
    """What is to be measured."""

    @property
    def output(self) -> str:
        """Which routine."""

    @property
    def samples(self) -> int:
        """Poses on the constraint, and as many in mid-iteration."""

    @property
    def domain(self) -> PoseDomain:
        """Bounds of the poses."""

    @property
    def is_counted(self) -> bool:
        """Whether instructions are counted."""

    def cases(self) -> tuple[Case, ...]:
        """The routines."""

    def builds(self) -> tuple[Build, ...]:
        """In which builds."""

    def asked(self) -> dict[str, object]:
        """The request as data."""


@dataclass(frozen=True, slots=True)
class AccuracyRequest:
    """Routines of joints.

    Attributes:
        joints: names in the catalogue; none: every routine of the library, in its plain builds.
        form: see `codegen.spec.request.Variant`; None means both.
        rows: see there.
        derivative: see there.
        output: of the routines that are measured.
        samples: poses on the constraint, and as many in mid-iteration.
        is_counted: whether instructions are counted too, where valgrind is installed.
        domain: bounds of the poses.
    """

    joints: tuple[str, ...] = ()
    form: str | None = None
    rows: str | None = None
    derivative: str | None = None
    output: str = "all"
    samples: int = SAMPLES
    is_counted: bool = True
    domain: PoseDomain = field(default_factory=PoseDomain)

    @property
    def is_full(self) -> bool:
        """Whether all builds are measured."""
        return bool(self.joints)

    def variants(self) -> tuple[Variant, ...]:
        """Choose the variants.

        Raises:
            SpecificationError: unknown names or options that do not go together; all mistakes at once.
        """
        mistakes = _mistakes(self.output, self.samples)
        try:
            chosen = build.variants(Options(self.joints, self.form, self.rows, self.derivative))
        except SpecificationError as error:
            mistakes += error.mistakes
        if mistakes:
            raise SpecificationError(mistakes)
        return chosen

    def cases(self) -> tuple[Case, ...]:
        """The routine of each variant."""
        return tuple(Case(v.joint, v.file_stem, partial(self._routine, v)) for v in self.variants())

    def _routine(self, variant: Variant) -> Routine:
        return routines(variant, (self.output,))[0]

    def builds(self) -> tuple[Build, ...]:
        """All builds; those of the whole library are `codegen.trade.builds.BASE`."""
        return builds(self.is_full)

    def asked(self) -> dict[str, object]:
        """The request as data."""
        return {name: getattr(self, name) for name in ("joints", "form", "rows", "derivative", "output")}


@dataclass(frozen=True, slots=True, eq=False)
class SceneRequest:
    """Routines of a scene.

    Attributes:
        scene: the mechanism as its file has it.
        form: of all joints that may have it; None: what the scene chooses, conventional and parametric.
        output: a quantity or product of the constraints; ``all``: the four quantities at once.
        samples: poses on the constraint, and as many in mid-iteration.
        is_counted: whether instructions are counted too.
        domain: bounds of the poses.
    """

    scene: Scene
    form: str | None = None
    output: str = "all"
    samples: int = SAMPLES
    is_counted: bool = True
    domain: PoseDomain = field(default_factory=PoseDomain)

    def check(self) -> None:
        """Refuse options that there are not.

        Raises:
            SpecificationError: all mistakes at once.
        """
        mistakes = _mistakes(self.output, self.samples)
        known = ("auto", *SCENE_FORMS[1:])
        if self.form is not None and self.form not in known:
            mistakes.append(Mistake("--form", f'there is no "{self.form}" of a scene', nearest(self.form, known)))
        if self.domain.distance:
            what = "is of joints: the ground holds a scene where it is"
            mistakes.append(Mistake("--domain distance", what, "leave it out"))
        if mistakes:
            raise SpecificationError(mistakes)

    def cases(self) -> tuple[Case, ...]:
        """The routine in each form."""
        self.check()
        forms = SCENE_FORMS if self.form is None else ("" if self.form == "auto" else self.form,)
        name = self.scene.name
        return tuple(Case(name, f"{name} {form}".strip(), partial(self._routine, form)) for form in forms)

    def builds(self) -> tuple[Build, ...]:
        """The builds of routines for one pose, without inputs that a scene's routine has not."""
        chosen = (one for one in builds(is_full=True) if one.lanes == 1 and not one.fma)
        return tuple(one for one in chosen if one.trigonometry in ("libm", "own"))

    def asked(self) -> dict[str, object]:
        """The request as data."""
        return {"scene": self.scene.name, "form": self.form, "output": self.output}

    def _routine(self, form: str) -> Routine:
        scene = flattened(self.scene) if self.scene.motion == "planar" else self.scene
        forms, dropped, pose = kept(("rows", scene, form), lambda: _judged(scene, form))
        system = System(Assembly(scene, forms, dropped))
        subject = SampledScene(system, layout(system, "index2"), row_names(system.assembly), None, pose, form)
        names = QUANTITIES if self.output == "all" else (self.output,)
        found = kept(("scene", scene, form, names), lambda: _scene_program(system, names))
        return Routine(subject, self.output, found, count(found), "S1 Tables 1 to 5, for this scene")


def _judged(scene: Scene, form: str) -> tuple[Mapping[str, Variant], frozenset[int], Pose]:
    """The forms of a scene's joints, the rows that are left out, and the pose at t = 0."""
    judged = judge(scene, form or None)
    return judged.assembly.forms, judged.assembly.dropped, judged.pose


def _scene_program(system: System, names: tuple[str, ...]) -> Program:
    """Straight-line code, also of what is emitted as loops: the bits are the same."""
    found = decided(compose(plan(system.assembly), lambda part: program(part, names)), "never")
    if isinstance(found, Looped):
        raise InternalError("loops that were not to be")
    return found


def _mistakes(output: str, samples: int) -> list[Mistake]:
    mistakes = []
    if output not in OUTPUTS:
        mistakes.append(Mistake("--output", f'there is no "{output}"', nearest(output, OUTPUTS)))
    if samples < 1:
        mistakes.append(Mistake("--samples", f"{samples} is no number of poses", "give 1 or more"))
    return mistakes
