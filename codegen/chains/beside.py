"""The equations of motion of a scene by absolute and by relative coordinates: how large they are, what is evaluated."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from codegen.chains.programs import FUSED
from codegen.chains.programs import program as chain_program
from codegen.chains.relative import relative
from codegen.ir.program import Program
from codegen.mechanics.chain.model import kept_rows
from codegen.mechanics.system import System
from codegen.scenes.generate import judge
from codegen.scenes.programs import program
from codegen.spec.plane import flattened
from codegen.spec.scene import Scene

ABSOLUTE = ("conventional", "parametric")
"""Forms by absolute coordinates."""

_APPLIED = ("D_E", "tau_A", "f_A")
"""Of a chain, what is the forces of a scene, gravity aside."""


@dataclass(frozen=True, slots=True)
class FormCost:
    """A scene in one form.

    Attributes:
        form: ``conventional``, ``parametric`` or ``relative``.
        unknowns: displacements, or joint coordinates.
        rows: of the constraints, without drives.
        with_gamma: what evaluates constraints, Jacobian, bias accelerations and forces at once; relative: the inertia
            matrix too.
        with_second: the same with the derivative of ``phi_q^T lambda`` in the place of the bias accelerations; None
            for relative coordinates.
    """

    form: str
    unknowns: int
    rows: int
    with_gamma: Program
    with_second: Program | None


def forms_beside(scene: Scene, progress: Callable[[str], None] = lambda _: None) -> tuple[FormCost, ...]:
    """Derive a scene in every form.

    Args:
        scene: the mechanism; its joints may say any form.
        progress: told each form as it is done.

    Raises:
        SpecificationError: a joint cannot be closed.
    """
    found = []
    for form in (*ABSOLUTE, "relative"):
        found.append(_relative(scene) if form == "relative" else _absolute(scene, form))
        progress(form)
    return tuple(found)


def _absolute(scene: Scene, form: str) -> FormCost:
    plane = flattened(scene) if scene.motion == "planar" else scene
    system = System(judge(plane, form).assembly)
    forces = ("force",) if all(body.mass for body in scene.bodies) else ()
    with_gamma, with_second = (
        program(system, ("phi", "phi_q", name, *forces)) for name in ("gamma", "phi_q_t_lambda_q")
    )
    size = len(system.assembly.columns), len(system.assembly.rows)
    return FormCost(form, *size, with_gamma, with_second)


def _relative(scene: Scene) -> FormCost:
    chain = relative(scene).chain
    names = [
        name for name in (*FUSED, *_APPLIED) if name in chain.wanted and (name != "D_E" or chain.acts_at_effectors)
    ]
    return FormCost("relative", len(chain.links), len(kept_rows(chain)), chain_program(chain, names), None)
