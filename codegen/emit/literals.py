"""Exact constants as C literals that round-trip."""

from __future__ import annotations

from codegen.ir.nearest import nearest_double
from codegen.ir.ops import Constant


def literal(constant: Constant) -> str:
    """Write a constant for C; ``JG_REAL`` gives it the type of the build."""
    return f"JG_REAL({nearest_double(constant)!r})"
