"""The pipeline in one place.

Stages, each a pure function of the one before:

1. ``spec``       options -> variants (:func:`codegen.spec.request.selected_variants`)
2. ``mechanics``  variant -> formulation -> derivation, symbolic (:mod:`codegen.mechanics`)
3. ``ir``         derivation -> program (:func:`codegen.ir.lower.lower`)
4. ``passes``     program -> program (:func:`codegen.passes.simplify`)
5. ``emit``       program -> C, CasADi, manifest (:mod:`codegen.emit`)

Writing is the last step: a package appears whole or not at all (:mod:`codegen.output`).
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

import codegen
from codegen.attitudes import attitude_routines
from codegen.emit.joint_subject import JointSubject
from codegen.emit.package import Unit, package, specification_hash, unit
from codegen.emit.prepared import prepare_geometry
from codegen.emit.routine import Routine
from codegen.emit.unit_subject import UnitSubject
from codegen.errors import Mistake, SpecificationError, nearest
from codegen.ir import text
from codegen.ir.lower import Part, Prices, SymbolicOutput, definition_notation, lower, notation
from codegen.ir.lower.lowering import Choose
from codegen.ir.lower.record import Records, fingerprint, replayed
from codegen.ir.lower.search import Choice, Graph, searched
from codegen.ir.program import Program
from codegen.mechanics import frames
from codegen.mechanics.derivation import AS_IT_STANDS, Derivation
from codegen.mechanics.equations import equations
from codegen.mechanics.formulation import Formulation, formulation
from codegen.mechanics.joints import BASIC, JOINTS, PAIRS
from codegen.mechanics.places import places
from codegen.parallel import parallel
from codegen.passes import simplify
from codegen.passes.contract_fma import contract_fma
from codegen.spec.joints import JointType
from codegen.spec.request import (
    BRANCH,
    PREPARE,
    PRODUCTS,
    QUANTITIES,
    Options,
    Variant,
    incompatibilities,
    selected_variants,
)
from flopcount.count import count

LIBRARY = Options()
"""The request for the whole committed library."""

PRICES = Prices()
"""What the search minimises: the number of operations."""

STARTS = range(2)
"""Seeds from which the search starts where nothing is on record."""

Check = Callable[[Routine], Program]
"""Gives the program of the conditions on the inputs of a routine."""

Progress = Callable[[str], None]
"""Told the name of each variant that is finished."""


@cache
def records() -> Records:
    """The choices that a long search found for the routines of the library (``make search``)."""
    content = resources.files(codegen).joinpath("records.json").read_text(encoding="utf-8")
    found: Records = json.loads(content)
    return found


_FOUND: dict[str, list[Choice]] = {}
"""Choices that this process has searched: equal joints of a scene have equal graphs."""


def choices_for(graph: Graph, outputs: Sequence[int]) -> list[Choice]:
    """Choose among the ways to evaluate nodes: what is on record, or the best that a short search finds."""
    key = fingerprint(graph, outputs)
    record = records().get(key)
    if record is not None:
        return [replayed(graph, outputs, record)]
    if key not in _FOUND:
        _FOUND[key] = searched(graph, outputs, STARTS)
    return _FOUND[key]


@dataclass(frozen=True)
class Model:
    """The symbolic model of one variant: mechanics' result, from which programs are lowered."""

    joint: JointType
    variant: Variant
    form: Formulation
    derivation: Derivation

    def outputs(self, names: Iterable[str]) -> tuple[SymbolicOutput, ...]:
        """Derive the named quantities."""
        return tuple(self.derivation.quantity(name) for name in names)

    def text(self, names: Iterable[str]) -> str:
        """Write the blocks of the named quantities in the notation of the papers."""
        lines = [
            f"{symbol} = {definition_notation(str(symbol), definition, self.form.aliases)}"
            for symbol, definition in self.form.stages.items()
        ]
        for output in self.outputs(names):
            lines.append(f"{output.name} {output.shape[0]}x{output.shape[1]}")
            lines += [f"  [{b.row},{b.column}] = {notation(b.expression, self.form.aliases)}" for b in output.blocks]
        return "\n".join(lines) + "\n"

    def program(self, names: Iterable[str]) -> Program:
        """Lower the named quantities to one simplified program."""
        return self.lowered(self.outputs(names))

    def lowered(
        self,
        outputs: tuple[SymbolicOutput, ...],
        is_substituted: bool | None = None,
        choose: Choose | None = None,
    ) -> Program:
        """Lower any outputs in the stages of this model to one simplified program, the cheapest that is found.

        Args:
            outputs: what to evaluate.
            is_substituted: whether the joint relation takes the place of the rotation matrices; by default where the
                derivative is substituted, but never in ``phi`` and ``branch``.
            choose: among the ways to evaluate them; what is on record, or a search.
        """
        programs = self.programs(outputs, is_substituted, choose or choices_for)
        return min(programs, key=lambda program: count(program).total)

    def programs(
        self, outputs: tuple[SymbolicOutput, ...], is_substituted: bool | None, choose: Choose
    ) -> list[Program]:
        """Lower any outputs in each of the ways that are chosen; see `lowered`."""
        arguments = frames.arguments(self.joint, self.form.coordinates, self.form.row_count)
        inputs = frames.inputs(self.form.coordinates, self.form.row_count)
        parts = self._parts(outputs, is_substituted)
        return [simplify(program) for program in lower(arguments, inputs, parts, PRICES, choose)]

    def _parts(self, outputs: tuple[SymbolicOutput, ...], is_substituted: bool | None) -> list[Part]:
        """Outputs by the frames they are written in, in the order in which they come."""
        inserted = bool(self.form.substitution) if is_substituted is None else is_substituted
        groups: dict[bool, list[SymbolicOutput]] = {}
        for output in outputs:
            groups.setdefault(inserted and output.name not in AS_IT_STANDS, []).append(output)
        return [Part(places(self.form, self.variant, key), tuple(group)) for key, group in groups.items()]


def joint_type(name: str) -> JointType:
    """Find a joint in the catalogue or among the trn x rot pairs.

    Raises:
        SpecificationError: there is none of that name.
    """
    known = {**JOINTS, **PAIRS, **{joint.name: joint for joint in BASIC.values()}}
    if name not in known:
        raise SpecificationError(
            [Mistake(f"joint {name}", "there is no such joint", nearest(name, {**JOINTS, **PAIRS}))]
        )
    return known[name]


def model(variant: Variant) -> Model:
    """Run the first two stages for a variant.

    Raises:
        SpecificationError: the joint is unknown or has no such variant.
    """
    joint = joint_type(variant.joint)
    mistakes = incompatibilities(joint, variant)
    if mistakes:
        raise SpecificationError(mistakes)
    form = formulation(joint, variant)
    return Model(joint, variant, form, Derivation(form))


def quantities_of(outputs: Sequence[str]) -> dict[str, tuple[str, ...]]:
    """Say which quantities each routine evaluates: those asked for one by one, and their fusion ``all``.

    Without a choice the library's routines: each quantity and product alone, and ``all`` of the four quantities.
    """
    if not outputs:
        singles: tuple[str, ...] = (*QUANTITIES, *PRODUCTS)
        fused: tuple[str, ...] = QUANTITIES
    else:
        singles = tuple(name for name in (*QUANTITIES, *PRODUCTS, BRANCH) if name in outputs)
        fused = singles or QUANTITIES
    routines = {name: (name,) for name in singles}
    return routines | ({"all": fused} if len(fused) > 1 or "all" in outputs else {})


def routines(variant: Variant, outputs: Sequence[str] = (), fma: bool = False) -> tuple[Routine, ...]:
    """Run the stages up to programs for one variant; ``fma``: with products and sums fused.

    Prepared geometry comes last, so that its routines do the operations of those on run-time geometry.
    """
    symbolic = model(variant)
    built = []
    for name, quantities in quantities_of(outputs).items():
        program = contracted(symbolic.program(quantities), fma)
        words = equations(symbolic.joint, variant, name)
        built.append(Routine(JointSubject(symbolic.joint, variant), name, program, count(program), words))
    return prepare_geometry(built) if variant.geometry == "prepared" else tuple(built)


def contracted(program: Program, fma: bool) -> Program:
    """Give the program with products and sums fused where that is asked for."""
    return contract_fma(program) if fma else program


def casadi_function(
    joint: str,
    form: str = "conventional",
    output: str = "all",
    rows: str | None = None,
    derivative: str = "exact",
    variation: str = "body",
    geometry: str = "runtime",
    matrices: str = "orthonormal",
) -> Any:
    """Build a joint routine as a ``casadi.Function``.

    Args:
        joint: name in the catalogue, or ``trnK_rotN``.
        form: ``conventional`` or ``parametric``.
        output: a quantity, a product, or ``all``.
        rows: of the parametric form; ``regular`` if left out.
        derivative: ``exact`` or ``substituted``.
        variation: ``body`` or ``world``.
        geometry: ``runtime``, or ``prepared``: of the library's routines, with the output ``prepare`` too.
        matrices: ``orthonormal``, or ``raw``: ``phi`` takes the rotation matrices as they are.

    Raises:
        SpecificationError: unknown names, or options that do not go together.
    """
    from codegen.emit import casadi

    outputs = () if output == PREPARE and geometry == "prepared" else (output,)
    options = Options(
        (joint,), form, rows, derivative, variation, outputs=outputs, geometry=geometry, matrices=matrices
    )
    chosen = variants(options)[0]
    if geometry == "prepared":
        found = next(routine for routine in routines(chosen) if routine.output == output)
        return casadi.casadi_function(chosen.routine_stem(output), found.program)
    program = model(chosen).program(quantities_of([output])[output])
    return casadi.casadi_function(f"{chosen.stem}_{output}", program)


@dataclass(frozen=True, slots=True)
class _Job:
    variant: Variant | None
    outputs: tuple[str, ...]
    real: str
    specification: str
    fma: bool
    batch: int | None = None
    check: Check | None = None

    @property
    def name(self) -> str:
        """For the progress."""
        return self.variant.file_stem if self.variant else "attitude"


def _emit_unit(job: _Job) -> Unit:
    """All stages for one variant, or for attitudes, in a worker process."""
    from codegen.emit import casadi

    if job.variant is None:
        built, subject = attitude_routines(job.outputs, job.fma), UnitSubject.of_attitudes()
    else:
        built, subject = routines(job.variant, job.outputs, job.fma), UnitSubject.of_variant(job.variant)
    serialised = {}
    for routine in built:
        name = routine.subject.routine_stem(routine.output)
        serialised[routine.output] = name, casadi.serialised(casadi.casadi_function(name, routine.program))
    return unit(
        subject, built, codegen.__version__, job.real, job.specification, serialised, job.fma, job.batch, job.check
    )


def variants(options: Options) -> tuple[Variant, ...]:
    """Choose the variants of a request; none where it asks for routines of attitudes only.

    Raises:
        SpecificationError: the options cannot be met; all mistakes at once.
    """
    chosen = selected_variants(options, JOINTS, PAIRS)
    return chosen if options.has_joints else ()


def generate(options: Options, progress: Progress = lambda _: None, check: Check | None = None) -> dict[str, bytes]:
    """Generate a package in memory.

    Args:
        options: what is asked for.
        progress: told each variant as it is done.
        check: gives the conditions that a routine asserts in debug builds; a function of a module, or a partial one.

    Returns:
        Path below the package's folder -> content.

    Raises:
        SpecificationError: the options cannot be met; all mistakes at once.
    """
    chosen = variants(options)
    joints = [joint_type(name) for name in dict.fromkeys(variant.joint for variant in chosen)]
    asked: dict[str, Any] = {"outputs": list(options.outputs), "real": options.real}
    asked |= {"fma": True} if options.fma else {}
    asked |= {"batch": options.batch} if options.batch else {}
    specification = specification_hash(codegen.__version__, joints, chosen, asked)
    groups: list[tuple[Variant | None, tuple[str, ...]]] = [(variant, options.of_joints) for variant in chosen]
    groups += [(None, options.of_attitudes)] if options.of_attitudes else []
    jobs = [
        _Job(*group, options.real, specification, options.fma, options.batch, check if group[0] else None)
        for group in groups
    ]
    units = parallel(_emit_unit, jobs, lambda job: progress(job.name))
    has_choices = check is not None
    return package(units, codegen.__version__, options.real, specification, options.fma, options.batch, has_choices)


def dump(options: Options, stage: str) -> Iterator[str]:
    """Give a stage of every routine of a request as text.

    Args:
        options: what is asked for.
        stage: ``model`` (the symbolic blocks) or ``program``.

    Raises:
        SpecificationError: unknown stage, or options that cannot be met.
    """
    if stage not in ("model", "program"):
        raise SpecificationError(
            [Mistake("--dump", f'there is no stage "{stage}"', nearest(stage, ("model", "program")))]
        )
    for variant in variants(options):
        if stage == "program":
            for routine in routines(variant, options.of_joints, options.fma):
                yield f"# {variant.routine_stem(routine.output)}\n{text.dump(routine.straight)}"
            continue
        symbolic = model(variant)
        for name, quantities in quantities_of(options.of_joints).items():
            if name != "all":
                yield f"# {variant.stem}_{name}\n{symbolic.text(quantities)}"
