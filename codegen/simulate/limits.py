"""What every run is asked for, and what marks its folder."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator

import codegen
from codegen.errors import Mistake


def limit_mistakes(tolerance: float, duration: float, outputs: int) -> Iterator[Mistake]:
    """Say which of the common settings of a run cannot be met.

    Args:
        tolerance: of the error test.
        duration: s.
        outputs: number of output times after the start.
    """
    if not 1e-13 <= tolerance <= 0.1:
        yield Mistake("--tol", f"{tolerance:g} is no tolerance", "give one from 1e-13 to 0.1")
    if not (math.isfinite(duration) and duration > 0):
        yield Mistake("--duration", f"{duration:g} s is no duration", "give a positive number")
    if not 1 <= outputs <= 10_000_000:
        yield Mistake("--outputs", f"{outputs} is no number of outputs", "give 1 to 10 million")


def run_manifest(kind: str, name: str) -> str:
    """What tells a folder of a run of ours from others.

    Args:
        kind: ``scene`` or ``chain``.
        name: of what was run.
    """
    generator = {"name": "jointgen", "version": codegen.__version__}
    document = {"schema_version": 1, "generator": generator, kind: name, "functions": []}
    return json.dumps(document, indent=1) + "\n"
