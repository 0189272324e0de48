"""The routines of a scene, chain or platform as files: header, source, CasADi, manifest, a README and an example.

Input: the routines. Output: path -> bytes; nothing is written here.
"""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from codegen.emit.c import Entry, entries, sparsity_functions, sparsity_symbol
from codegen.emit.casadi_external import external_name, external_source, has_external
from codegen.emit.comments import comment
from codegen.emit.environment import render
from codegen.emit.guarded import guarded
from codegen.emit.literals import literal
from codegen.emit.manifest import entry_record, manifest
from codegen.emit.package import banner
from codegen.emit.packed import packed
from codegen.emit.routine import Parameter, Routine
from codegen.ir.ops import Constant
from codegen.ir.program import Program

_WIDTH = 108


@dataclass(frozen=True, slots=True)
class ScenePackage:
    """Everything that goes into the files of a scene, chain or platform.

    Attributes:
        name: of the scene or chain.
        routines: single quantities first, ``all`` last.
        version: of jointgen.
        specification: hash of the mechanism and of what was asked for.
        real: default number type, ``double`` or ``float``.
        record: what the manifest says of the mechanism as a whole.
        casadi: output -> serialised CasADi function.
        start: argument -> its entries at t = 0, for the example.
        readme: text of the README.
        kind: ``scene``, ``chain`` or ``platform``.
        situation: what the example is about.
        more: further files: path -> text.
        batch: what the manifest says of batch routines.
        choices: whether routines choose between values.
        checks: output -> conditions that its routine asserts in debug builds.
        fma: whether products and sums are fused.
    """

    name: str
    routines: tuple[Routine, ...]
    version: str
    specification: str
    real: str
    record: dict[str, Any]
    casadi: Mapping[str, bytes]
    start: Mapping[str, Sequence[Constant]]
    readme: str
    kind: str = "scene"
    situation: str = "as it stands at t = 0"
    more: Mapping[str, str] = field(default_factory=dict)
    batch: dict[str, Any] | None = None
    choices: bool = False
    checks: Mapping[str, Program] = field(default_factory=dict)
    fma: bool = False


def scene_files(package: ScenePackage) -> dict[str, bytes]:
    """Write the files of a scene or chain: path below its folder -> content."""
    emitted = [_checked(entry, package) for routine in package.routines for entry in entries(routine)]
    patterns = _patterns(package)
    files = {
        f"{package.name}.h": _header(package, emitted, list(patterns)),
        f"{package.name}.c": _source(package, emitted, list(patterns.values())),
        "jg_real.h": real_header(
            package.version, package.real, package.choices, package.batch is not None, package.fma
        ),
        f"{package.name}_example.c": _example(package, [e for e in emitted if e.storage != "dense"][-1]),
        "README.md": package.readme,
        "manifest.json": _manifest(package, emitted),
    } | dict(package.more)
    if package.real == "double" and any(has_external(routine) for routine in package.routines):
        files["casadi/external.c"] = external_source(
            package.routines,
            "external.c",
            f"{package.name}.h",
            banner(package.version),
            f"{package.kind} {package.name}",
            package.specification,
        )
    content = {path: text.encode() for path, text in files.items()}
    return content | {f"casadi/{output}.casadi": data for output, data in package.casadi.items()}


def _checked(entry: Entry, package: ScenePackage) -> Entry:
    check = package.checks.get(entry.routine.output)
    return entry if check is None or entry.storage == "dense" else guarded(entry, check)


def real_header(version: str, real: str, choices: bool, has_batch: bool = False, fma: bool = False) -> str:
    """Text of ``jg_real.h`` for one mechanism.

    Args:
        version: of jointgen.
        real: default number type.
        choices: whether it has absolute values and choices.
        has_batch: whether ``jg_own.h`` lies beside it.
        fma: whether products and sums are fused.
    """
    return render(
        "c/jg_real.h.j2", banner=banner(version), real=real, fma=fma, batch=has_batch or None, choices=choices
    )


def _patterns(package: ScenePackage) -> dict[str, str]:
    return {symbol: text for routine in package.routines for symbol, text, _ in sparsity_functions(routine)}


def _header(package: ScenePackage, emitted: Sequence[Entry], patterns: Sequence[str]) -> str:
    introduction = [
        f"Routines of the {package.kind} {package.name}: what stands in README.md beside this file.",
        "",
        "Matrices are column-major. Entries ending in _nz store the structural nonzeros in compressed columns, in the",
        "pattern given by the _sparsity function; entries ending in _dense store the whole matrix. Arrays of one call",
        "must not overlap.",
    ]
    declarations: list[tuple[tuple[str, ...], str]] = [
        (
            (f"@brief Pattern of {symbol.removesuffix('_sparsity')}: {{nrow, ncol, colind..., row...}}.",),
            f"const int *{symbol}(void)",
        )
        for symbol in patterns
    ]
    declarations += [(tuple(comment(entry)), entry.signature) for entry in emitted]
    return render(
        "c/header.h.j2",
        name=package.name,
        banner=banner(package.version),
        specification=package.specification,
        introduction=introduction,
        guard=f"{package.kind.upper()}_{package.name.upper()}",
        declarations=declarations,
    )


def _source(package: ScenePackage, emitted: Sequence[Entry], patterns: Sequence[str]) -> str:
    return render(
        "c/source.c.j2",
        file=f"{package.name}.c",
        banner=banner(package.version),
        options=f"{package.kind} {package.name}, real {package.real}",
        specification=package.specification,
        header=f"{package.name}.h",
        functions=[*patterns, *(entry.text for entry in emitted)],
    )


def _manifest(package: ScenePackage, emitted: Sequence[Entry]) -> str:
    records = [entry_record(entry, f"{package.name}.h", f"{package.name}.c", package.real) for entry in emitted]
    by_output = {routine.output: routine for routine in package.routines}
    casadi = []
    for output in package.casadi:
        subject = by_output[output].subject
        record = {"name": subject.routine_stem(output), "file": f"casadi/{output}.casadi", "output": output}
        if package.real == "double" and has_external(by_output[output]):
            name = external_name(subject.stem, output)
            record |= {"external": {"name": name, "source": "casadi/external.c"}}  # type: ignore[dict-item]
        casadi.append(record)
    whole = {package.kind: package.record}
    made = (package.version, package.real, package.specification)
    return manifest(*made, records, casadi, package.fma, package.batch, whole)


def _example(package: ScenePackage, entry: Entry) -> str:
    """The mechanism as it stands, through its last routine."""
    declared = entry.parameters
    arrays = [
        {"name": p.name, "rows": _rows([literal(constant) for constant in package.start[p.name]])}
        for p in declared
        if p.direction == "in"
    ]
    outputs = [
        {"name": p.name, "length": p.length, "pattern": _pattern(entry, p)} for p in declared if p.direction == "out"
    ]
    call = f"{entry.symbol}({', '.join(p.name for p in declared)});"
    return render(
        "c/scene_example.c.j2",
        banner=banner(package.version),
        specification=package.specification,
        name=package.name,
        whole=f"{package.kind} {package.name} {package.situation}",
        has_matrix=any(output["pattern"] for output in outputs),
        has_vector=not all(output["pattern"] for output in outputs),
        arrays=arrays,
        outputs=outputs,
        calls=textwrap.wrap(call, _WIDTH, subsequent_indent="        "),
    )


def _pattern(entry: Entry, parameter: Parameter) -> str:
    """The function that gives the pattern of a stored matrix; none for a vector."""
    if parameter.layout != "compressed-columns":
        return ""
    return sparsity_symbol(entry.routine, entry.routine.program.output(parameter.name))


def _rows(words: Sequence[str]) -> list[str]:
    return packed(words, _WIDTH)
