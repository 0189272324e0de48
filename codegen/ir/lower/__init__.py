"""Lowering: from staged matrix expressions (sympy) to a scalar program, by way of vectors.

The one place of ``ir`` that knows sympy. Its stages:

1. `read`       expressions free of frames: vectors, scalars, dyadics (`space`, `polynomial`)
2. `layout`     every quantity that may be computed and every way to compute it (`vector_forms`, `scalar_forms`,
   `block_forms`, `raw_forms`)
3. `search`     the cheapest choice among all of them
4. `scalarise`  the choice as scalar operations, under the names of the stages (`naming`)
"""

from codegen.ir.lower.alternatives import Prices
from codegen.ir.lower.lowering import Part, lower, structural_rows
from codegen.ir.lower.notation import definition_notation, notation
from codegen.ir.lower.operators import Dot, Tilde
from codegen.ir.lower.outputs import Block, SymbolicOutput
from codegen.ir.lower.places import Places

__all__ = [
    "Block",
    "Dot",
    "Part",
    "Places",
    "Prices",
    "SymbolicOutput",
    "Tilde",
    "definition_notation",
    "lower",
    "notation",
    "structural_rows",
]
