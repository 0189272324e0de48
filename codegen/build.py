"""The pipeline in one place.

Stages, each a pure function of the one before:

1. ``spec``       options -> variants (:func:`codegen.spec.selection.selected_variants`)
2. ``mechanics``  variant -> formulation -> derivation, symbolic (:mod:`codegen.mechanics`)
3. ``ir``         derivation -> program (:func:`codegen.ir.lower.lower`), with 2 in :mod:`codegen.models`
4. ``passes``     program -> program (:func:`codegen.passes.simplify`)
5. ``emit``       program -> C, CasADi, manifest (:mod:`codegen.emit`)

Writing is the last step: a package appears whole or not at all (:mod:`codegen.output`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import codegen
from codegen.attitudes import attitude_routines
from codegen.counted import Counted, counted
from codegen.emit.joint_subject import JointSubject
from codegen.emit.package import Unit, package, specification_hash, unit
from codegen.emit.prepared import prepare_geometry
from codegen.emit.routine import Routine
from codegen.emit.unit_subject import UnitSubject
from codegen.errors import Mistake, SpecificationError, nearest
from codegen.ir import text
from codegen.ir.program import Program
from codegen.mechanics.equations import equations
from codegen.mechanics.joints import JOINTS, PAIRS
from codegen.models import joint_type, model
from codegen.parallel import parallel
from codegen.passes.contract_fma import contract_fma
from codegen.passes.overlap import overlap
from codegen.spec.request import BRANCH, PREPARE, PRODUCTS, QUANTITIES, Options, Variant
from codegen.spec.selection import selected_variants
from flopcount.count import count

LIBRARY = Options()
"""The request for the whole committed library."""

ISSUED = 3
"""Operations that start in a cycle of the processor for which a routine is ordered."""

Check = Callable[[Routine], Program]
"""Gives the program of the conditions on the inputs of a routine."""

Progress = Callable[[str], None]
"""Told the name of each variant that is finished."""


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

    Prepared geometry comes late, so that its routines do the operations of those on run-time geometry; what is last
    is the order of the operations.
    """
    symbolic = model(variant)
    built = []
    for name, quantities in quantities_of(outputs).items():
        program = contracted(symbolic.program(quantities), fma)
        words = equations(symbolic.joint, variant, name)
        built.append(Routine(JointSubject(symbolic.joint, variant), name, program, count(program), words))
    finished = prepare_geometry(built) if variant.geometry == "prepared" else tuple(built)
    return tuple(replace(routine, program=overlap(routine.straight, ISSUED)) for routine in finished)


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
    return _emitted(job, _built(job))


def _emit_counted(job: _Job) -> tuple[Unit, Counted]:
    """The same of a variant of the library, with the counts that the tables compare."""
    built = _built(job)
    return _emitted(job, built), counted({routine.output: routine.straight for routine in built})


def _built(job: _Job) -> tuple[Routine, ...]:
    if job.variant is None:
        return attitude_routines(job.outputs, job.fma)
    return routines(job.variant, job.outputs, job.fma)


def _emitted(job: _Job, built: Sequence[Routine]) -> Unit:
    from codegen.emit import casadi

    subject = UnitSubject.of_attitudes() if job.variant is None else UnitSubject.of_variant(job.variant)
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
    jobs = _jobs(options, check)
    units = parallel(_emit_unit, jobs, lambda job: progress(job.name))
    return _packaged(options, jobs[0].specification, units, check is not None)


def generate_library(progress: Progress = lambda _: None) -> tuple[dict[str, bytes], dict[Variant, Counted]]:
    """Generate the package of the whole library, and count its derivatives.

    Args:
        progress: told each variant as it is done.

    Returns:
        The files as for `generate`, and the counts of each variant.
    """
    jobs = _jobs(LIBRARY, None)
    made = parallel(_emit_counted, jobs, lambda job: progress(job.name))
    files = _packaged(LIBRARY, jobs[0].specification, [unit for unit, _ in made], False)
    return files, {job.variant: counts for job, (_, counts) in zip(jobs, made, strict=True) if job.variant}


def _jobs(options: Options, check: Check | None) -> list[_Job]:
    chosen = variants(options)
    joints = [joint_type(name) for name in dict.fromkeys(variant.joint for variant in chosen)]
    asked: dict[str, Any] = {"outputs": list(options.outputs), "real": options.real}
    asked |= {"fma": True} if options.fma else {}
    asked |= {"batch": options.batch} if options.batch else {}
    specification = specification_hash(codegen.__version__, joints, chosen, asked)
    groups: list[tuple[Variant | None, tuple[str, ...]]] = [(variant, options.of_joints) for variant in chosen]
    groups += [(None, options.of_attitudes)] if options.of_attitudes else []
    return [
        _Job(*group, options.real, specification, options.fma, options.batch, check if group[0] else None)
        for group in groups
    ]


def _packaged(options: Options, specification: str, units: Sequence[Unit], has_choices: bool) -> dict[str, bytes]:
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
