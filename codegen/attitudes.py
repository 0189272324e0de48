"""The routines of attitudes, from the request to programs: stages as in `codegen.build`."""

from __future__ import annotations

from collections.abc import Sequence

from codegen.emit.attitude_subject import AttitudeSubject
from codegen.emit.routine import Routine
from codegen.ir.program import Program
from codegen.mechanics.attitude import attitude_program
from codegen.passes import simplify
from codegen.passes.contract_fma import contract_fma
from flopcount.count import count

EQUATIONS = {
    "orthonormalise": "X -> (X + X^-T) / 2, Higham, Computing the polar decomposition, 1986",
    "check_orthonormal": "A = cof A = det(A) A^-T, det A = 1",
}


def attitude_routines(outputs: Sequence[str], fma: bool = False) -> tuple[Routine, ...]:
    """Give the routines of a rotation matrix.

    Args:
        outputs: of `codegen.spec.request.ATTITUDES`.
        fma: whether products and sums are fused.
    """
    found = []
    for output in outputs:
        program: Program = simplify(attitude_program(output))
        program = contract_fma(program) if fma else program
        found.append(Routine(AttitudeSubject(), output, program, count(program), EQUATIONS[output]))
    return tuple(found)
