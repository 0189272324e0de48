"""Lowering: from staged matrix expressions (sympy) to a scalar program. The one place of ``ir`` that knows sympy."""

from codegen.ir.lower.lowering import Block, SymbolicOutput, lower
from codegen.ir.lower.nodes import Dot, Tilde
from codegen.ir.lower.notation import definition_notation, notation

__all__ = ["Block", "Dot", "SymbolicOutput", "Tilde", "definition_notation", "lower", "notation"]
