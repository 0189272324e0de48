"""Drop the instructions that no output depends on."""

from __future__ import annotations

from codegen.ir.program import Program
from codegen.passes.rewrite import reorder


def drop_unused(program: Program) -> Program:
    """Keep the live instructions, in their order."""
    return reorder(program, [position for position, alive in enumerate(program.live()) if alive])
