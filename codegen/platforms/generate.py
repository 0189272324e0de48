"""From a platform to the files of its package."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import codegen
from codegen.emit.batch import LAYOUTS, BatchRoutine, batch_record, batch_routine
from codegen.emit.batch_files import vector_headers
from codegen.emit.batch_strided import STRIDED, strided_routine
from codegen.emit.c import Entry, entries
from codegen.emit.environment import render
from codegen.emit.package import banner
from codegen.emit.platform_subject import PlatformSubject, platform_record
from codegen.emit.routine import Routine
from codegen.emit.scene_package import ScenePackage, scene_files
from codegen.errors import Mistake, SpecificationError, nearest
from codegen.ir.ops import Constant
from codegen.parallel import parallel
from codegen.platforms.attitudes import attitude_entries
from codegen.platforms.programs import routine, wanted
from codegen.platforms.readme import readme
from codegen.spec.platform import VARIANTS, Platform
from codegen.spec.platform_file.reading import wanted_mistakes
from codegen.spec.request import REALS

LANES = {"double": 4, "float": 8}
"""Poses in a group of the batch routines: one vector register of 32 bytes."""

Progress = Callable[[str], None]
"""Told what is finished."""


def with_options(platform: Platform, variant: str | None, real: str, fma: bool = False) -> Platform:
    """Give the platform with the options of the command line in the place of those of the file.

    Raises:
        SpecificationError: there is no such option, or the variant does not offer what is asked for.
    """
    asked = (("--variant", variant, tuple(VARIANTS)), ("--real", real, REALS))
    mistakes = [
        Mistake(name, f'there is no "{value}"', nearest(value, known))
        for name, value, known in asked
        if value is not None and value not in known
    ]
    if mistakes:
        raise SpecificationError(mistakes)
    wanted = replace(platform.wanted, variant=variant or platform.wanted.variant, fma=fma)
    chosen = replace(platform, wanted=wanted)
    mistakes = list(wanted_mistakes(chosen.wanted, "--variant"))
    if mistakes:
        raise SpecificationError(mistakes)
    return chosen


def generate_platform(
    platform: Platform, real: str = "double", progress: Progress = lambda _: None
) -> dict[str, bytes]:
    """Generate the package of a platform in memory.

    Args:
        platform: the platform.
        real: ``double`` or ``float``.
        progress: told each routine as it is done.

    Returns:
        Path below the package's folder -> content.
    """
    jobs = [_Job(platform, output, names, real) for output, names in wanted(platform).items()]
    built = parallel(_built, jobs, lambda job: progress(job.output))
    routines = tuple(found for found, _ in built)
    specification = hashlib.sha256(repr((codegen.__version__, platform, real)).encode()).hexdigest()
    batches = [found for made in routines for found in batch_routines(made, LANES[real])]
    package = ScenePackage(
        platform.name,
        routines,
        codegen.__version__,
        specification,
        real,
        platform_record(platform),
        {job.output: data for job, (_, data) in zip(jobs, built, strict=True)},
        home_arguments(platform),
        readme(PlatformSubject(platform), routines, LANES[real], specification),
        "platform",
        "at home",
        _batch_files(platform, batches, specification, real),
        _batch_manifest(platform, batches, LANES[real]),
        True,
        fma=platform.wanted.fma,
    )
    return scene_files(package)


def steps(platform: Platform) -> int:
    """Number of times that progress is told."""
    return len(wanted(platform))


def batch_routines(made: Routine, lanes: int) -> list[BatchRoutine]:
    """The batch functions of a routine: groups and arrays, then arrays of any strides."""
    stored: list[Entry] = [entry for entry in entries(made) if entry.storage != "dense"]
    return [
        emitted
        for entry in stored
        for emitted in (
            batch_routine(made, entry.parameters, lanes, "pose"),
            strided_routine(made, entry.parameters, lanes),
        )
    ]


def batch_source(name: str, batches: Sequence[BatchRoutine], lanes: int, specification: str, options: str) -> str:
    """The text of the source of batch functions."""
    return render(
        "c/batch_source.c.j2",
        file=f"{name}_batch{lanes}.c",
        banner=banner(codegen.__version__),
        options=options,
        specification=specification,
        header=f"{name}_batch{lanes}.h",
        lanes=lanes,
        vectors="jg_batch.h",
        functions=[emitted.text for emitted in batches],
    )


def batch_header(name: str, batches: Sequence[BatchRoutine], lanes: int, specification: str) -> str:
    """The text of the header of batch functions."""
    introduction = [
        f"Routines of the platform {name} for many poses at once, {lanes} in a group; {name}.h has those for one pose",
        "and describes the arguments. Arrays of one call must not overlap.",
    ]
    return render(
        "c/header.h.j2",
        name=f"{name}_batch{lanes}",
        banner=banner(codegen.__version__),
        specification=specification,
        introduction=introduction,
        guard=f"PLATFORM_{name.upper()}_BATCH{lanes}",
        declarations=[(entry.comment, entry.signature) for emitted in batches for entry in emitted.entries],
    )


def home_arguments(platform: Platform) -> Mapping[str, Sequence[Constant]]:
    """The arguments of the routines in the home pose."""
    found = {"o": [Constant(x) for x in platform.home.position]}
    name, values = attitude_entries(platform.wanted.attitude, platform.home.rotation)
    return found | {name: [Constant(x) for x in values]}


def _batch_files(
    platform: Platform, batches: Sequence[BatchRoutine], specification: str, real: str
) -> Mapping[str, str]:
    lanes, name = LANES[real], platform.name
    headers = vector_headers(lanes, banner(codegen.__version__), choices=True)
    return {
        f"{name}_batch{lanes}.c": batch_source(name, batches, lanes, specification, f"platform {name}, real {real}"),
        f"{name}_batch{lanes}.h": batch_header(name, batches, lanes, specification),
    } | {f"{header}.h": text for header, text in headers.items()}


def _batch_manifest(platform: Platform, batches: Sequence[BatchRoutine], lanes: int) -> dict[str, Any]:
    file = f"{platform.name}_batch{lanes}"
    layouts = LAYOUTS | {STRIDED: "entry (i, k) of pose j of array a at [j s[3 a] + i s[3 a + 1] + k s[3 a + 2]]"}
    return {
        "lanes": lanes,
        "layouts": {layout: words.replace("joint", "pose") for layout, words in layouts.items()},
        "functions": [
            batch_record(entry, emitted.text, f"{file}.h", f"{file}.c", lanes)
            for emitted in batches
            for entry in emitted.entries
        ],
    }


@dataclass(frozen=True)
class _Job:
    platform: Platform
    output: str
    names: tuple[str, ...]
    real: str


def _built(job: _Job) -> tuple[Routine, bytes]:
    from codegen.emit import casadi

    made = routine(job.platform, job.output, job.names, job.real)
    function = casadi.casadi_function(made.subject.routine_stem(job.output), made.straight)
    return made, casadi.serialised(function)
