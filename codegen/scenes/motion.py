"""The equations of motion of a scene: the programs of its system put together over one state vector."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from fractions import Fraction

from codegen.dynamics import jacobian, residual
from codegen.dynamics.directions import by_motion
from codegen.dynamics.layout import Layout, layout
from codegen.ir.lower.lowering import Choose
from codegen.ir.program import Program
from codegen.mechanics.mass import mass
from codegen.mechanics.system import System
from codegen.models import choices_for_scenes
from codegen.passes import simplify
from codegen.scenes.programs import program

BETA = Fraction(20)
"""1/s, of Baumgarte's stabilisation: a drift goes back as ``exp(-20 t)``."""


@dataclass(frozen=True)
class Dae:
    """The equations of motion of a scene for an implicit integrator.

    Attributes:
        layout: of the state.
        residual: ``F(t, y, ydot)``.
        jacobian: ``dF/dy + cj dF/dydot``.
    """

    layout: Layout
    residual: Program
    jacobian: Program


def dae(
    system: System,
    form: str = "index2",
    left_out: Collection[str] = (),
    beta: Fraction = BETA,
    choose: Choose = choices_for_scenes,
) -> Dae:
    """Compose the equations of motion.

    Args:
        system: the scene with its joints, drives and forces.
        form: one of `codegen.dynamics.layout.FORMS`.
        left_out: terms of the Jacobian that are left out, of `codegen.dynamics.jacobian.SECOND`.
        beta: of Baumgarte's stabilisation, 1/s.
        choose: among the ways to evaluate the programs of the system.
    """
    return Dae(
        layout(system, form),
        residual_program(system, form, beta, choose),
        jacobian_program(system, form, left_out, beta, choose),
    )


def residual_program(
    system: System, form: str = "index2", beta: Fraction = BETA, choose: Choose = choices_for_scenes
) -> Program:
    """Compose the residual ``F(t, y, ydot)``, see `dae`."""
    values = program(system, residual_quantities(form), choose)
    return simplify(residual.residual(system, layout(system, form), values, _inertia(system), beta))


def jacobian_program(
    system: System,
    form: str = "index2",
    left_out: Collection[str] = (),
    beta: Fraction = BETA,
    choose: Choose = choices_for_scenes,
) -> Program:
    """Compose the Jacobian ``dF/dy + cj dF/dydot``, see `dae`."""
    slopes = program(system, jacobian_quantities(form), choose)
    gamma = simplify(by_motion(program(system, ("gamma",), choose), system)) if form == "index1" else None
    state, inertia = layout(system, form), _inertia(system)
    return simplify(jacobian.jacobian(system, state, slopes, inertia, left_out=left_out, gamma=gamma, beta=beta))


def residual_quantities(form: str) -> tuple[str, ...]:
    """The quantities of a system that the residual is composed of."""
    return residual.INDEX1 if form == "index1" else residual.INDEX2


def jacobian_quantities(form: str) -> tuple[str, ...]:
    """The quantities of a system that the Jacobian is composed of; that of index 1 takes ``gamma`` besides."""
    return (*jacobian.INDEX2, "force") if form == "condensed" else jacobian.INDEX2


def _inertia(system: System) -> Program:
    assembly = system.assembly
    return mass(assembly.scene, assembly.arrays, len(assembly.columns), system.arguments())
