"""The pipeline for scenes: scene -> assembly -> program -> C, CasADi, manifest.

The stages are those of `codegen.build`; before them the joints get their forms and redundant rows are left out.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass, replace
from fractions import Fraction

from codegen.build import PRICES, choices_for
from codegen.dynamics import jacobian, residual
from codegen.dynamics.directions import by_motion
from codegen.dynamics.layout import Layout, layout
from codegen.ir.lower import lower, structural_rows
from codegen.ir.program import Program
from codegen.mechanics.assembly import Assembly
from codegen.mechanics.mass import mass
from codegen.mechanics.system import System
from codegen.passes import simplify
from codegen.passes.select import select
from flopcount.count import count

BETA = Fraction(20)
"""1/s, of Baumgarte's stabilisation: a drift goes back as ``exp(-20 t)``."""


def without_zero_rows(assembly: Assembly) -> Assembly:
    """Leave out the rows that are identically zero, as those across the plane of a planar mechanism are."""
    inputs = assembly.inputs()
    rows = set().union(*(structural_rows(part, inputs) for part in assembly.parts(("phi",))))
    return replace(assembly, dropped=assembly.dropped | (frozenset(range(assembly.all_rows)) - rows))


def program(assembly: Assembly | System, names: Iterable[str]) -> Program:
    """Lower quantities of the constraints of a scene to one simplified program, the cheapest that is found.

    Args:
        assembly: the scene with the forms of its joints; a `System` has its drives and forces too.
        names: ``phi``, ``phi_q``, ``phi_q_t_lambda_q``, ``gamma``, ``phi_q_v``, ``phi_q_t_lambda``.
    """
    names = tuple(names)
    chosen = {name: assembly.selection(name) for name in names}
    parts = assembly.parts(names)
    programs = lower(assembly.arguments(), assembly.inputs(), parts, PRICES, choices_for)
    return min((simplify(select(found, chosen)) for found in programs), key=lambda found: count(found).total)


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


def dae(system: System, form: str = "index2", left_out: Collection[str] = (), beta: Fraction = BETA) -> Dae:
    """Compose the equations of motion.

    Args:
        system: the scene with its joints, drives and forces.
        form: ``index2``, stabilised after Gear, Gupta and Leimkuhler, or ``index1`` after Baumgarte.
        left_out: terms of the Jacobian that are left out, of `codegen.dynamics.jacobian.SECOND`.
        beta: of Baumgarte's stabilisation, 1/s.
    """
    state = layout(system, form)
    is_index2 = form == "index2"
    assembly = system.assembly
    inertia = mass(assembly.scene, assembly.arrays, len(assembly.columns), system.arguments())
    values = program(system, residual.INDEX2 if is_index2 else residual.INDEX1)
    slopes = program(system, jacobian.INDEX2)
    gamma = None if is_index2 else simplify(by_motion(program(system, ("gamma",)), system))
    return Dae(
        state,
        simplify(residual.residual(system, state, values, inertia, beta)),
        simplify(jacobian.jacobian(system, state, slopes, inertia, left_out=left_out, gamma=gamma, beta=beta)),
    )
