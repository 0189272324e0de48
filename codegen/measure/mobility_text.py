"""A mobility report as lines for readers and as data for ``summary.json``."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from codegen.measure.mobility import JudgedPart, Mobility, Verdict
from codegen.measure.rank import TOLERANCE
from codegen.measure.replacements import Replacement, Suggestion


def lines(found: Mobility) -> tuple[str, ...]:
    """Write a report, one statement a line; equal parts are told once."""
    total = f"{found.rows} rows, {found.columns} coordinates, rank {found.rank}, {_freedoms(found.freedoms)}"
    told = [total] if found.is_closed else []
    alike: dict[int, list[JudgedPart]] = {}
    for part in found.parts:
        if part.verdict:
            alike.setdefault(id(part.verdict), []).append(part)
        else:
            told += [f"{_title([part])} does not close:", *(f"  {gap}" for gap in part.open_joints)]
    for parts in alike.values():
        if verdict := parts[0].verdict:
            told.append(f"{_title(parts)}: {_count(verdict)}")
            told += [f"  {line}" for line in _part_lines(parts[0], verdict)]
    return tuple(told)


def as_data(found: Mobility) -> dict[str, Any]:
    """Give a report as data for JSON."""
    return {
        "rows": found.rows,
        "rank": found.rank,
        "dof": found.freedoms,
        "dropped_rows": [{"joint": joint, "row": row} for joint, row in found.redundant],
        "parts": [_part_data(part) for part in found.parts],
    }


def _title(parts: Sequence[JudgedPart]) -> str:
    names = ", ".join(parts[0].bodies) or "ground"
    others = f" and {len(parts) - 1} equal parts" if len(parts) > 1 else ""
    return f"part of {names}{others}"


def _count(verdict: Verdict) -> str:
    numbers = f"{verdict.rows} rows, {verdict.columns} coordinates, rank {verdict.rank}"
    return f"{numbers}, {_freedoms(verdict.freedoms)}"


def _freedoms(count: int) -> str:
    return f"{count} degree{'' if count == 1 else 's'} of freedom"


def _redundant(count: int) -> str:
    return f"{count} redundant row{'' if count == 1 else 's'}"


def _part_lines(part: JudgedPart, verdict: Verdict) -> Iterator[str]:
    yield from _states(verdict)
    if verdict.redundant:
        yield f"{_redundant(len(verdict.redundant))} left out:"
        for joint in dict.fromkeys(joint for joint, _ in part.redundant):
            rows = ", ".join(row for owner, row in part.redundant if owner == joint)
            yield f'  joint "{joint}": {rows}'
        yield from _reasons(verdict)
    for suggestion in verdict.suggestions:
        yield f"{'to avoid it' if not suggestion.left else 'to lessen it'}: {_suggested(part, suggestion)}"
    if not verdict.suggestions and verdict.redundant and not verdict.infinitesimal:
        yield "no freer joints are known that avoid it"


def _states(verdict: Verdict) -> Iterator[str]:
    """What is out of the ordinary, and how sure the rank is."""
    if verdict.infinitesimal:
        yield (
            f"shaky: {verdict.infinitesimal} direction{'s' if verdict.infinitesimal > 1 else ''} of motion cannot be"
            " followed any finite way, and forces against it grow without bound"
        )
    if verdict.columns and not verdict.freedoms:
        yield "locked: it does not move"
    if verdict.is_singular:
        yield f"singular configuration: at the given pose the rank is {verdict.ranks[0].rank}, elsewhere {verdict.rank}"
    dropped = sum(found.rank < verdict.rank for found in verdict.ranks[1:])
    if dropped:
        yield f"the rank drops at {dropped} of {len(verdict.ranks) - 1} other poses too"
    if not verdict.is_common:
        yield "no set of rows is independent at all poses: those kept depend on each other at some"
    if not verdict.is_clear:
        yield "a rank is not sure: a singular value lies near the tolerance"
    regular = [found for found in verdict.ranks if found.rank == verdict.rank]
    kept, dropped_value = min(found.kept for found in regular), max(found.dropped for found in regular)
    below = f", the others are below {dropped_value:.0e}" if dropped_value else ""
    yield (
        f"at {len(verdict.ranks)} poses, tolerance {TOLERANCE:.0e}: the smallest singular value that counts is "
        f"{kept:.1e} of the largest{below}"
    )


def _reasons(verdict: Verdict) -> Iterator[str]:
    """Why rows are redundant."""
    for name in dict.fromkeys(found.name for found in verdict.groups if found.dimension < 6):
        own = [found for found in verdict.groups if found.name == name and found.dimension < 6]
        loops = f"{len(own)} loop{'s' if len(own) > 1 else ''}"
        motion = name or f"of dimension {own[0].dimension}"
        rows = sum(6 - found.dimension for found in own)
        yield f"{rows} whatever the dimensions are, from {loops} in a group of motions: {motion}"
    if verdict.by_dimensions:
        yield (
            f"{verdict.by_dimensions} by special dimensions: overconstrained, and "
            f"{'mobile' if verdict.freedoms else 'closed'} only as long as these are kept exactly"
        )


def _suggested(part: JudgedPart, suggestion: Suggestion) -> str:
    told = " and ".join(_replacement(part, replacement) for replacement in suggestion.replacements)
    left = f" ({_redundant(suggestion.left)} left)" if suggestion.left else ""
    return told + left


def _replacement(part: JudgedPart, replacement: Replacement) -> str:
    note = f" ({replacement.note})" if replacement.note else ""
    return f'{replacement.new}{note} instead of {replacement.old} at joint "{part.joints[replacement.joint]}"'


def _part_data(part: JudgedPart) -> dict[str, Any]:
    data: dict[str, Any] = {"bodies": list(part.bodies), "joints": list(part.joints)}
    if not part.verdict:
        gaps = [{"joint": gap.joint, "length_m": gap.length, "angle_rad": gap.angle} for gap in part.open_joints]
        return data | {"closes": False, "open_joints": gaps}
    verdict = part.verdict
    return data | {
        "closes": True,
        "rows": verdict.rows,
        "coordinates": verdict.columns,
        "rank": verdict.rank,
        "rank_given_pose": verdict.ranks[0].rank,
        "dof": verdict.freedoms,
        "infinitesimal_dof": verdict.infinitesimal,
        "dropped_rows": [{"joint": joint, "row": row} for joint, row in part.redundant],
        "dropped_by_special_dimensions": verdict.by_dimensions,
        "suggestions": [_suggested(part, suggestion) for suggestion in verdict.suggestions],
    }
