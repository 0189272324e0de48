"""The arithmetic of IDA's vectors that is compiled with the equations, for their length."""

from __future__ import annotations

import codegen
from codegen.emit.environment import render
from codegen.emit.package import banner

MOST = 6
"""Vectors that are combined in one pass: what a BDF of order 5 predicts from."""


def vector_headers(size: int) -> dict[str, str]:
    """Write the header of the operations: name -> text.

    Args:
        size: entries of a vector.
    """
    return {"jg_vector.h": render("simulate/jg_vector.h.j2", banner=banner(codegen.__version__), size=size, most=MOST)}
