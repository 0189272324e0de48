"""The files of batch routines: a source a variant, a header a joint, and what they share."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from codegen.emit import trigonometry
from codegen.emit.batch import LAYOUTS, BatchRoutine, batch_record, batch_routine
from codegen.emit.c import Entry
from codegen.emit.environment import render
from codegen.emit.unit_subject import UnitSubject
from codegen.ir.program import Program


@dataclass(frozen=True, slots=True)
class BatchUnit:
    """The batch routines of one source file.

    Attributes:
        subject: what they are of.
        lanes: joints in a group.
        source: text of the source file.
        routines: what it defines.
    """

    subject: UnitSubject
    lanes: int
    source: str
    routines: tuple[BatchRoutine, ...]

    @property
    def file(self) -> str:
        """Name of the source file."""
        return f"{self.subject.file_stem}_batch{self.lanes}.c"

    @property
    def header(self) -> str:
        """Name of the header, without ending; the variants of a joint share it."""
        return f"{self.subject.header}_batch{self.lanes}"


def batch_unit(
    subject: UnitSubject,
    entries: Sequence[Entry],
    banner: str,
    options: str,
    specification: str,
    lanes: int,
    checks: Mapping[str, Program],
) -> BatchUnit:
    """Emit the batch routines of one source file: those of its functions that store nonzeros or vectors.

    ``checks`` gives, by the symbol for one, the conditions that they assert in debug builds.
    """
    emitted = tuple(
        batch_routine(entry.routine, entry.parameters, lanes, subject.object, checks.get(entry.symbol))
        for entry in entries
        if entry.storage != "dense"
    )
    source = render(
        "c/batch_source.c.j2",
        file=f"{subject.file_stem}_batch{lanes}.c",
        banner=banner,
        options=options,
        specification=specification,
        header=f"jointgen/{subject.header}_batch{lanes}.h",
        lanes=lanes,
        vectors="jointgen/jg_batch.h",
        functions=[routine.text for routine in emitted],
    )
    return BatchUnit(subject, lanes, source, emitted)


def batch_headers(units: Sequence[BatchUnit], lanes: int, banner: str, specification: str) -> Mapping[str, str]:
    """Headers of the joints, and those with the vectors and their functions: path -> text."""
    files = vector_headers(lanes, banner)
    for header in dict.fromkeys(unit.header for unit in units):
        same = [unit for unit in units if unit.header == header]
        files[header] = _header(header, same, lanes, banner, specification)
    return {f"c/include/jointgen/{name}.h": text for name, text in files.items()}


def vector_headers(lanes: int, banner: str, choices: bool = False) -> dict[str, str]:
    """The headers with the vectors and their functions, by name without ending.

    Args:
        lanes: numbers in a vector.
        banner: first line of each.
        choices: whether absolute values and choices are among the functions, and arrays of any strides.
    """
    constants = {real: trigonometry.definitions(real) for real in trigonometry.CONSTANTS}
    return {
        "jg_own": render("c/jg_own.h.j2", banner=banner),
        "jg_batch": render("c/jg_batch.h.j2", banner=banner, batch=lanes, choices=choices),
        "jg_trigonometry": render("c/jg_trigonometry.h.j2", banner=banner, constants=constants),
    }


def _header(header: str, units: Sequence[BatchUnit], lanes: int, banner: str, specification: str) -> str:
    subject = units[0].subject
    many = {"joint": "joints", "body": "bodies"}[subject.object]
    introduction = [
        f"{subject.topic} for many {many} at once, {lanes} in a group; {subject.header}.h has those",
        f"for one {subject.object} and describes the arguments. Arrays of one call must not overlap.",
    ]
    entries = [entry for unit in units for routine in unit.routines for entry in routine.entries]
    return render(
        "c/header.h.j2",
        name=header,
        banner=banner,
        specification=specification,
        introduction=introduction,
        guard=header.upper(),
        declarations=[(entry.comment, entry.signature) for entry in entries],
    )


def batch_manifest(units: Sequence[BatchUnit], lanes: int) -> dict[str, Any]:
    """What the manifest tells of the batch routines."""
    return {
        "lanes": lanes,
        "layouts": LAYOUTS,
        "functions": [
            batch_record(entry, routine.text, f"c/include/jointgen/{unit.header}.h", f"c/src/{unit.file}", lanes)
            for unit in units
            for routine in unit.routines
            for entry in routine.entries
        ],
    }
