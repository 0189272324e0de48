"""The attitude of a body as the subject of routines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from codegen.emit.routine import Preparation, Words
from codegen.ir.looped import Looped
from codegen.ir.program import Argument, Program, Result

ATTITUDE = "attitude"

ATTITUDE_BRIEFS = {
    "orthonormalise": "The rotation nearest to A, by three steps of Newton's method for the polar factor",
    "check_orthonormal": "How far A is from a rotation: norm of A less its cofactors, and of det A less 1",
}
"""What each routine does, in a line."""

ATTITUDE_DETAILS = {
    "orthonormalise": (
        "To rounding where no singular value of A is off 1 by more than 0.02; 0.1 leaves 1e-9. A mirrored A stays "
        "mirrored, a singular one gives no numbers. A and the result must not overlap."
    ),
    "check_orthonormal": ("0 for rotations only; 4 for a mirrored one. Entries off by e give about 4 e."),
}
"""What a user must know besides."""


@dataclass(frozen=True, slots=True)
class AttitudeSubject:
    """A rotation matrix, body to world or between any two frames."""

    @property
    def stem(self) -> str:
        """Start of the symbols."""
        return f"jg_{ATTITUDE}"

    def routine_stem(self, output: str) -> str:
        """The symbol of a routine."""
        return f"{self.stem}_{output}"

    def part(self, kind: int) -> AttitudeSubject:
        """There is one kind."""
        return self

    def argument(self, argument: Argument) -> Words:
        """Axes and unit of A."""
        return Words("body to world, or between any two frames", "1")

    def output(self, output: Result) -> Words:
        """Axes and unit of an output."""
        return Words("as A, column-major" if output.name == "orthonormalise" else "norm", "1")

    def brief(self, output: str) -> str:
        """What a routine does, in a line."""
        return f"{ATTITUDE_BRIEFS[output]}."

    def details(self, output: str, program: Program | Looped, preparation: Preparation | None) -> Sequence[str]:
        """What a user must know besides."""
        return [ATTITUDE_DETAILS[output]]

    def record(self) -> dict[str, Any]:
        """What the manifest says of it."""
        return {"of": ATTITUDE}
