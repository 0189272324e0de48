"""Passes: ``Program -> Program``, each a verb, none changes the value of an output in exact arithmetic."""

from codegen.passes.pipeline import simplify

__all__ = ["simplify"]
