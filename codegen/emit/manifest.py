"""The manifest: everything a program must know to call any routine."""

from __future__ import annotations

import hashlib
import json
from typing import Any

from codegen.emit.c import Entry, sparsity_symbol
from codegen.emit.routine import Parameter
from codegen.ir.looped import Loop, Looped
from codegen.passes.flatten import flatten
from flopcount.count import count

SCHEMA_VERSION = 1


def entry_record(entry: Entry, header: str, source: str, real: str) -> dict[str, Any]:
    """Describe one C function.

    Args:
        entry: the function.
        header: path of its header, from the folder of the manifest.
        source: path of its source, from the folder of the manifest.
        real: number type of the package.
    """
    routine = entry.routine
    matrices = [output for output in routine.program.outputs if output.sparsity.ncol > 1]
    record: dict[str, Any] = {
        "symbol": entry.symbol,
        "header": header,
        "source": source,
        **routine.subject.record(),
        "real": real,
        "output": routine.output,
        "storage": entry.storage,
        "outputs": [output.name for output in routine.program.outputs],
        "arguments": [_parameter_record(parameter) for parameter in entry.parameters],
        "sparsity": {
            output.name: {
                "nrow": output.sparsity.nrow,
                "ncol": output.sparsity.ncol,
                "colind": list(output.sparsity.colind),
                "row": list(output.sparsity.row),
                "function": sparsity_symbol(routine, output),
            }
            for output in matrices
        },
        "operations": routine.counts.as_dict(),
        "temporaries": entry.temporaries,
        "equations": routine.equations,
        "sha256": hashlib.sha256(entry.text.encode()).hexdigest(),
    }
    if isinstance(routine.program, Looped):
        record["loops"] = [_loop_record(routine.program, loop) for loop in routine.program.loops]
    if routine.preparation:
        prepare = routine.preparation
        record["prepare"] = {"symbol": prepare.symbol, "operations": prepare.counts.as_dict()}
    return record


def _parameter_record(parameter: Parameter) -> dict[str, Any]:
    record: dict[str, Any] = {
        "name": parameter.name,
        "direction": parameter.direction,
        "shape": list(parameter.shape),
        "length": parameter.length,
        "layout": parameter.layout,
        "frame": parameter.frame,
        "unit": parameter.unit,
    }
    if parameter.members:
        record["members"] = [
            {"name": name, "offset": offset, "shape": list(shape), "meaning": meaning} | _repeats(parameter, offset)
            for name, offset, shape, meaning in parameter.members
        ]
    return record


def _repeats(parameter: Parameter, offset: int) -> dict[str, int]:
    number, stride = parameter.repeats.get(offset, (1, 0))
    return {"count": number, "stride": stride} if number > 1 else {}


def _loop_record(looped: Looped, loop: Loop) -> dict[str, Any]:
    """Describe the instances of a loop: how many, and entries of every array from one to the next."""
    flat = flatten(looped, loop)
    pieces = [
        {"array": p.array, "start": p.start, "length": p.length, "stride": p.stride if loop.count > 1 else 0}
        for p in (*flat.inputs, *flat.outputs)
    ]
    return {"instances": loop.count, "operations": count(loop.program).as_dict(), "pieces": pieces}


def manifest(
    version: str,
    real: str,
    specification: str,
    functions: list[dict[str, Any]],
    casadi: list[dict[str, Any]],
    fma: bool = False,
    batch: dict[str, Any] | None = None,
    whole: dict[str, Any] | None = None,
) -> str:
    """Write the manifest of a package.

    ``fma``: its C holds fused multiply-adds and nothing else may be contracted. What is told of batch routines stands
    under a key of its own, and so does what is told of a mechanism as a ``whole``, by its kind.
    """
    document = {
        "schema_version": SCHEMA_VERSION,
        "generator": {"name": "jointgen", "version": version},
        "specification_sha256": specification,
        "real": real,
        "fma": fma,
        "functions": functions,
        "casadi": casadi,
    } | {name: told for name, told in (("batch", batch), *(whole or {}).items()) if told}
    return json.dumps(document, indent=1, ensure_ascii=True) + "\n"
