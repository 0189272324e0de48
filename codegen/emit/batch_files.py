"""The files of batch routines: a source a variant, a header a joint, and what they share."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from codegen.emit import trigonometry
from codegen.emit.batch import LAYOUTS, BatchRoutine, batch_record, batch_routine
from codegen.emit.c import Entry
from codegen.emit.environment import render
from codegen.spec.request import Variant


@dataclass(frozen=True, slots=True)
class BatchUnit:
    """The batch routines of one variant.

    Attributes:
        variant: form and options.
        lanes: joints in a group.
        source: text of the source file.
        routines: what it defines.
    """

    variant: Variant
    lanes: int
    source: str
    routines: tuple[BatchRoutine, ...]

    @property
    def file(self) -> str:
        """Name of the source file."""
        return f"{self.variant.file_stem}_batch{self.lanes}.c"

    @property
    def header(self) -> str:
        """Name of the header, without ending; the variants of a joint share it."""
        return f"{self.variant.joint}_batch{self.lanes}"


def batch_unit(
    variant: Variant, entries: Sequence[Entry], banner: str, options: str, specification: str, lanes: int
) -> BatchUnit:
    """Emit the batch routines of one variant: those of its functions that store nonzeros or vectors."""
    emitted = tuple(
        batch_routine(entry.routine, entry.parameters, lanes) for entry in entries if entry.storage != "dense"
    )
    source = render(
        "c/batch_source.c.j2",
        file=f"{variant.file_stem}_batch{lanes}.c",
        banner=banner,
        options=options,
        specification=specification,
        header=f"jointgen/{variant.joint}_batch{lanes}.h",
        lanes=lanes,
        vectors="jointgen/jg_batch.h",
        functions=[routine.text for routine in emitted],
    )
    return BatchUnit(variant, lanes, source, emitted)


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
    joint = units[0].variant.joint
    introduction = [
        f"Constraint routines of the {joint} joint for many joints at once, {lanes} in a group; {joint}.h has those",
        "for one joint and describes the arguments. Arrays of one call must not overlap.",
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
