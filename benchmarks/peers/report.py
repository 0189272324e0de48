"""The results as JSON and as Markdown; nothing is measured here."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from benchmarks.peers import symbolic
from benchmarks.peers.compile import Setting
from benchmarks.peers.measure import Measured
from benchmarks.peers.vm import VirtualTime

FLOOR = "floor"
AMONG = {
    "ratio": (),
    "to generators": symbolic.FORMS,
    "fed phi or formulas": ("phi", "formulas"),
}
"""Heading -> forms of the peers that ours is compared with; none means all."""


@dataclass(frozen=True, slots=True)
class JointResult:
    """Everything measured for one joint.

    Attributes:
        joint: name in the catalogue.
        counted: operations of ours by the manifest.
        measured: candidates.
        virtual: functions in CasADi's virtual machine.
    """

    joint: str
    counted: int | None
    measured: Sequence[Measured]
    virtual: Sequence[VirtualTime]

    def ns(self, measured: Measured, setting: Setting) -> float | None:
        """Median time of a candidate."""
        timing = measured.timings.get(str(setting))
        return timing.ns if timing else None

    def named(self, name: str) -> list[Measured]:
        """Candidates of a peer or of ours."""
        return [m for m in self.measured if m.candidate.name == name]

    def best(self, measured: Iterable[Measured], setting: Setting) -> Measured | None:
        """The fastest of some candidates; None if none was timed."""
        timed = [(self.ns(m, setting), k, m) for k, m in enumerate(measured)]
        return min(((ns, k, m) for ns, k, m in timed if ns is not None), default=(0.0, 0, None))[2]

    def peers(self) -> list[Measured]:
        """Candidates that are neither ours nor the floor."""
        return [m for m in self.measured if m.candidate.form not in ("jointgen", "copy")]

    def ours(self) -> list[str]:
        """Labels of our packages."""
        return list(dict.fromkeys(m.candidate.name for m in self.measured if m.candidate.form == "jointgen"))

    def ratio(self, label: str, setting: Setting, forms: Sequence[str] = ()) -> float | None:
        """Time of ours over that of the fastest peer, among all or among those fed in some forms."""
        peers = [m for m in self.peers() if not forms or m.candidate.form in forms]
        ours, peer = self.best(self.named(label), setting), self.best(peers, setting)
        if ours is None or peer is None:
            return None
        return _known(self.ns(ours, setting)) / _known(self.ns(peer, setting))


def _known(value: float | None) -> float:
    if value is None:
        raise ValueError("a candidate that was chosen for its time has one")
    return value


def geometric_mean(values: Sequence[float | None]) -> float | None:
    """Geometric mean of the values that there are."""
    known = [value for value in values if value]
    return math.exp(sum(map(math.log, known)) / len(known)) if known else None


def as_json(results: Sequence[JointResult], settings: Sequence[Setting], environment: dict[str, str]) -> str:
    """All figures, of every form."""
    document = {
        "environment": environment,
        "settings": [str(setting) for setting in settings],
        "joints": {result.joint: _record(result, settings) for result in results},
        "geometric_mean": {
            among: {
                label: {str(s): geometric_mean([r.ratio(label, s, forms) for r in results]) for s in settings}
                for label in _labels(results)
            }
            for among, forms in AMONG.items()
        },
    }
    return json.dumps(document, indent=1) + "\n"


def _record(result: JointResult, settings: Sequence[Setting]) -> dict[str, Any]:
    candidates = [
        {
            "name": m.candidate.name,
            "form": m.candidate.form,
            "generation_seconds": m.candidate.seconds,
            "operations": m.operations,
            "timings": {name: asdict(timing) for name, timing in m.timings.items()},
        }
        for m in result.measured
    ]
    return {
        "ratio": {
            among: {label: {str(s): result.ratio(label, s, forms) for s in settings} for label in result.ours()}
            for among, forms in AMONG.items()
        },
        "manifest_operations": result.counted,
        "candidates": candidates,
        "virtual_machine": [asdict(v) for v in result.virtual],
    }


def _labels(results: Sequence[JointResult]) -> list[str]:
    return list(dict.fromkeys(label for result in results for label in result.ours()))


def as_markdown(results: Sequence[JointResult], settings: Sequence[Setting], environment: dict[str, str]) -> str:
    """The tables to read."""
    parts = ["# Beside other code generators", "", *(f"- {name}: {value}" for name, value in environment.items()), ""]
    for label in _labels(results):
        for setting in settings:
            parts += [f"## {label} and the fastest peer, {setting}", "", *_summary(results, label, setting), ""]
    if any(result.virtual for result in results):
        parts += ["## CasADi's virtual machine", "", *_virtual(results), ""]
    for result in results:
        parts += [f"## {result.joint}", "", *_detail(result, settings), ""]
    return "\n".join(parts)


def _summary(results: Sequence[JointResult], label: str, setting: Setting) -> list[str]:
    rows = []
    for result in results:
        ours, peer = result.best(result.named(label), setting), result.best(result.peers(), setting)
        floor = result.best(result.named(FLOOR), setting)
        rows.append(
            [
                result.joint,
                _time(ours, setting),
                _total(ours),
                _time(peer, setting),
                f"{peer.candidate.name}, {peer.candidate.form}" if peer else "-",
                _total(peer),
                _time(floor, setting),
                *(_number(result.ratio(label, setting, forms), 2) for forms in AMONG.values()),
            ]
        )
    means = [geometric_mean([result.ratio(label, setting, forms) for result in results]) for forms in AMONG.values()]
    rows.append(["geometric mean", *[""] * 6, *(_number(mean, 2) for mean in means)])
    heads = [
        "joint",
        f"{label}, ns",
        "operations",
        "fastest peer, ns",
        "which",
        "its operations",
        "floor, ns",
        *AMONG,
    ]
    return _table(heads, rows)


def _detail(result: JointResult, settings: Sequence[Setting]) -> list[str]:
    rows = []
    for name in dict.fromkeys(m.candidate.name for m in result.measured):
        best = result.best(result.named(name), settings[0]) or result.named(name)[0]
        timing = best.timings.get(str(settings[0]))
        row = [name, best.candidate.form, f"{timing.error:.0e}" if timing and name != FLOOR else "-", _total(best)]
        row += [_number(best.candidate.seconds, 2)]
        for setting in settings:
            each = best.timings.get(str(setting))
            row += [_time(best, setting), _number(each.instructions if each else None, 0)]
        row += [_number(t.compile_seconds if t else None, 2) for t in (best.timings.get(str(s)) for s in settings)]
        rows.append(row)
    heads = ["candidate", "form", "error", "operations", "generation, s"]
    for setting in settings:
        heads += [f"{setting.short}: ns", "instructions"]
    heads += [f"compile, s: {setting.short}" for setting in settings]
    return _table(heads, rows)


def _virtual(results: Sequence[JointResult]) -> list[str]:
    rows = []
    for result in results:
        theirs = [v for v in result.virtual if v.name == "casadi" and v.ns is not None]
        best = min(theirs, key=lambda v: _known(v.ns), default=None)
        for v in result.virtual:
            if v.name == "casadi" and v is not best and v.ns is not None:
                continue
            ratio = v.ns / _known(best.ns) if v.ns and best else None
            time = "wrong" if v.ns is None else f"{v.ns:.0f} ± {v.spread or 0:.0f}"
            rows.append([result.joint, v.name, v.form, f"{v.error:.0e}", str(v.instructions), str(v.operations), time])
            rows[-1].append(_number(ratio, 2))
    heads = ["joint", "function", "form", "error", "instructions", "operations", "ns", "ratio"]
    return _table(heads, rows)


def _total(measured: Measured | None) -> str:
    return str(measured.operations["total"]) if measured and measured.operations else "-"


def _time(measured: Measured | None, setting: Setting) -> str:
    timing = measured.timings.get(str(setting)) if measured else None
    if timing is None:
        return "-"
    return "wrong" if timing.ns is None else f"{timing.ns:.1f} ± {timing.spread or 0:.1f}"


def _number(value: float | None, digits: int) -> str:
    return "-" if value is None else f"{value:.{digits}f}"


def _table(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    widths = [max(len(row[k]) for row in [heads, *rows]) for k in range(len(heads))]
    lines = ["| " + " | ".join(x.ljust(w) for x, w in zip(row, widths, strict=True)) + " |" for row in [heads, *rows]]
    return [lines[0], "|" + "|".join("-" * (w + 2) for w in widths) + "|", *lines[1:]]
