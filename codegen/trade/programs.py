"""Routines of a variant and what is compiled of them, kept between runs: generation takes seconds, measurement less."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path

from codegen import build
from codegen.cache import cache_folder, content_digest, kept
from codegen.emit.environment import template_folder
from codegen.emit.routine import Routine
from codegen.spec.request import Variant

_HEADERS = ("c", "measure")
"""Templates that compiled routines depend on."""


def routines(variant: Variant, outputs: Sequence[str] = (), fma: bool = False) -> tuple[Routine, ...]:
    """Give the routines of a variant as `codegen.build.routines` does, from the cache where it has them."""
    return kept((variant, tuple(outputs), fma), lambda: build.routines(variant, outputs, fma))


def builds_folder() -> Path:
    """Where routines are kept that were compiled with the headers that these templates give."""
    folder = cache_folder() / f"builds-{_headers()}"
    folder.mkdir(exist_ok=True)
    return folder


@cache
def _headers() -> str:
    return content_digest(template_folder(), [template_folder() / part for part in _HEADERS])
