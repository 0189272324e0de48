"""The equations of motion of a scene, ready to be called: equal mechanisms of it are derived once and run in loops."""

from __future__ import annotations

from collections.abc import Collection

from codegen.dynamics.layout import layout
from codegen.emit.scene_subject import SceneSubject
from codegen.ir.program import Program
from codegen.measure.constraints import Array
from codegen.mechanics.assembly import Assembly
from codegen.mechanics.plan import plan
from codegen.mechanics.system import System
from codegen.passes import simplify
from codegen.passes.unroll import unroll
from codegen.scenes.compose import compose
from codegen.scenes.generate import row_names
from codegen.scenes.loops import decided
from codegen.scenes.motion import jacobian_program, jacobian_quantities, residual_program, residual_quantities
from codegen.scenes.programs import estimate, lower_ahead, program
from codegen.simulate.compiled import Compiled, compiled


def equations(system: System, form: str, y: Array, ydot: Array, left_out: Collection[str] = ()) -> Compiled:
    """Derive and compile residual and Jacobian.

    Args:
        system: the scene.
        form: one of `codegen.dynamics.layout.FORMS`.
        y: [n] a state; the Jacobian there tells good pivots.
        ydot: [n] its rate.
        left_out: terms that the Jacobian lacks.

    Raises:
        SpecificationError: there is no C compiler.
    """

    def residual(part: System) -> Program:
        return residual_program(part, form, choose=estimate)

    def jacobian(part: System) -> Program:
        return jacobian_program(part, form, left_out, choose=estimate)

    planned = plan(system.assembly, is_condensed=form == "condensed")
    subject = SceneSubject(system, layout(system, form), row_names(system.assembly), planned)
    if form == "index1":  # what loops run over is laid out for index 2
        return compiled(subject, residual(system), jacobian(system), y, ydot)
    rows, columns = (decided(compose(planned, lowered), "auto") for lowered in (residual, jacobian))
    return compiled(subject, rows, columns, y, ydot)


ACCELERATIONS = ("phi_q", "gamma", "force")
"""What the accelerations at the start follow from."""

WATCHED = ("phi", "phi_q")
"""What a run is watched by."""


def lower_run(system: System, undropped: Assembly, form: str) -> None:
    """Lower everything that a run takes on all cores, the longest first.

    Args:
        system: the scene.
        undropped: with its redundant rows.
        form: one of `codegen.dynamics.layout.FORMS`.
    """
    kinds = plan(system.assembly).kinds
    parts = (system,) if form == "index1" else kinds
    asked = [(part, names) for names in (jacobian_quantities(form), residual_quantities(form)) for part in parts]
    asked += [(part, ACCELERATIONS) for part in kinds]
    asked += [(part, WATCHED) for part in plan(undropped).kinds]
    lower_ahead([(part, names, estimate)] for part, names in asked)


def quantities(system: System, names: tuple[str, ...]) -> Program:
    """Lower quantities of a scene in a hurry, section by section."""
    return simplify(unroll(compose(plan(system.assembly), lambda part: program(part, names, estimate))))
