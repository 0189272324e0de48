"""What S1 takes as given when it counts operations (SPEC S1.4, rule R0), as outputs of their own.

On the conventional side ``A_ij`` and ``d_ij``; on the parametric side ``A_ij(alpha) = C_i H C_j^T`` with its sines and
cosines, and its derivatives by alpha.
"""

from __future__ import annotations

import sympy

from codegen.ir.lower import Block, SymbolicOutput
from codegen.mechanics.formulation import Formulation
from codegen.mechanics.frames import A_ij, C_i, C_j, H, d_ij
from codegen.mechanics.variation import Variation, coefficient

RELATIVE_ROTATION = sympy.MatMul(C_i, H, sympy.Transpose(C_j))
"""S1 Eq. (11)."""


def conventional_quantities() -> dict[str, tuple[SymbolicOutput, ...]]:
    """``A_ij`` and ``d_ij``, each as a program of its own."""
    return {
        "A_ij": (SymbolicOutput("A_ij", (3, 3), (Block(0, 0, A_ij),)),),
        "d_ij": (SymbolicOutput("d_ij", (3, 1), (Block(0, 0, d_ij),)),),
    }


def parametric_quantities(form: Formulation) -> dict[str, tuple[SymbolicOutput, ...]]:
    """``A_ij(alpha)``, and the same with its derivatives; empty where nothing rotates.

    Args:
        form: of the parametric form.
    """
    value = SymbolicOutput("A_ij", (3, 3), (Block(0, 0, RELATIVE_ROTATION),))
    derivatives = tuple(
        SymbolicOutput(f"A_ij_{displacement}", (3, 3), (Block(0, 0, _derivative(form, displacement)),))
        for displacement, column in form.displacements
        if column >= 12 and _derivative(form, displacement) != sympy.ZeroMatrix(3, 3)
    )
    return {"A_ij(alpha)": (value,), "with derivatives": (value, *derivatives)}


def _derivative(form: Formulation, displacement: sympy.Symbol) -> sympy.Expr:
    """Column by column: a variation is read off vectors."""
    variation = Variation(form.algebra, form.stages, form.virtual, form.partials)
    varied = variation.of(RELATIVE_ROTATION)
    return coefficient(varied, displacement, form.algebra)
