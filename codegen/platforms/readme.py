"""The README of a platform: its functions, what they cost, and how to call them."""

from __future__ import annotations

from collections.abc import Sequence

import codegen
from codegen.emit.environment import render
from codegen.emit.package import banner
from codegen.emit.parameters import parameters
from codegen.emit.platform_subject import OUTPUTS, PlatformSubject
from codegen.emit.routine import Routine
from codegen.scenes.markdown import Code, table

_VARIANTS = {
    "robust": "Every index is right to a few eps times the condition number of J.",
    "balanced": "As robust where only one value of a block is small; one closed form a block instead of two.",
    "fast": "Gram matrices: errors grow with the square of the condition number of J.",
    "values": "The four products alone, right to eps kappa; less where J loses two degrees at once.",
    "smooth": "C is the condition number of Frobenius: smooth, 1 for equal values only.",
    "literal": "The formulas as printed, for comparison: half of the digits are lost at repeated values.",
}


def readme(subject: PlatformSubject, routines: Sequence[Routine], lanes: int, specification: str) -> str:
    """Write the README.

    Args:
        subject: the platform.
        routines: everything that is emitted.
        lanes: of the batch routines.
        specification: hash of the request.
    """
    platform = subject.platform
    fused = " Products and sums are fused: compile with `-mfma` or `-march=native`, and with `-ffp-contract=off`."
    functions = [
        (
            Code(routine.symbol),
            ", ".join(p.name for p in parameters(routine, False) if p.direction == "in"),
            OUTPUTS[routine.output][0],
            OUTPUTS[routine.output][2],
            str(routine.counts),
        )
        for routine in routines
    ]
    return render(
        "platform/README.md.j2",
        name=platform.name,
        banner=banner(codegen.__version__),
        specification=specification,
        variant=platform.wanted.variant,
        words=_VARIANTS[platform.wanted.variant] + fused * platform.wanted.fma,
        lanes=lanes,
        functions=table(("function", "takes", "gives", "unit", "operations"), functions),
    )
