"""A request for routines: joint, form and options; `codegen.spec.selection` says which variants it means.

Two routines that differ in an option have different symbols; the defaults leave no trace in them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

FORMS = ("conventional", "parametric")
ROWS = ("regular", "table4", "quaternion")
DERIVATIVES = ("exact", "substituted")
VARIATIONS = ("body", "world")
REALS = ("double", "float")
BATCHES = (2, 4, 8, 16)
"""Joints in a group of the batch routines."""
GEOMETRIES = ("runtime", "prepared")
MATRICES = ("orthonormal", "raw")

QUANTITIES = ("phi", "phi_q", "phi_q_t_lambda_q", "gamma")
"""What the fused routine of the library evaluates."""

PRODUCTS = ("phi_q_v", "phi_q_t_lambda")
"""Products with the Jacobian, for solvers that never form it."""

OUTPUTS = (*QUANTITIES, *PRODUCTS, "all")
"""Everything that can be asked for; ``all`` is the fused routine."""

BRANCH = "branch"
"""The check that a joint was closed as it was meant, not on another branch."""

ATTITUDES = ("orthonormalise", "check_orthonormal")
"""Routines of a rotation matrix, whatever the joint; a package has them where they are asked for."""

ASKED = (*OUTPUTS, BRANCH, *ATTITUDES)
"""What ``--outputs`` admits."""

PREPARE = "prepare"
"""The routine that prepares the geometry for all others of its variant."""


@dataclass(frozen=True, slots=True)
class Variant:
    """One joint in one form with one set of options.

    Attributes:
        joint: name in the catalogue.
        form: ``conventional`` or ``parametric``.
        rows: rows of the rotational constraint; None in the conventional form.
        derivative: ``exact``, or ``substituted`` (S1: the joint relation is inserted before differentiating again).
        variation: axes of the virtual rotations: ``body`` or ``world``.
        geometry: ``runtime``, or ``prepared``: what depends on it alone is computed once.
        matrices: ``orthonormal``: ``A^T A = I`` is taken for granted; ``raw``: ``phi`` takes the matrices as they are.
    """

    joint: str
    form: str
    rows: str | None
    derivative: str = "exact"
    variation: str = "body"
    geometry: str = "runtime"
    matrices: str = "orthonormal"

    @property
    def translations(self) -> str:
        """Axes of the virtual translations: ``body`` (``delta r' = A^T delta r``) or ``world``."""
        return "body" if self.form == "parametric" and self.variation == "body" else "world"

    @property
    def stem(self) -> str:
        """Start of the C symbols: ``jg_<joint>_<form>[_<variant>]``."""
        words = ["jg", self.joint, self.form]
        words += [self.rows] if self.rows not in (None, "regular") else []
        words += [self.derivative] if self.derivative != "exact" else []
        words += [self.variation] if self.variation != "body" else []
        words += [self.matrices] if self.matrices != "orthonormal" else []
        words += [self.geometry] if self.geometry != "runtime" else []
        return "_".join(str(word) for word in words)

    @property
    def file_stem(self) -> str:
        """Name of the source file, without ending."""
        return self.stem.removeprefix("jg_")

    def routine_stem(self, output: str) -> str:
        """The C symbol of a routine without its storage ending."""
        stem = replace(self, geometry="runtime").stem if output == PREPARE else self.stem
        return f"{stem}_{output}"


@dataclass(frozen=True, slots=True)
class Options:
    """What the command line asks for; None means every value that the joint admits.

    Attributes:
        joints: names in the catalogue; empty means the library.
        form: see `Variant`.
        rows: see `Variant`.
        derivative: see `Variant`.
        variation: see `Variant`.
        real: ``double`` or ``float``.
        outputs: names out of `ASKED`; empty means all of `OUTPUTS`.
        batch: joints in a group of the batch routines; none means that there are none.
        fma: whether products and sums are fused, explicitly and alike with every compiler.
        geometry: see `Variant`.
        matrices: see `Variant`.
    """

    joints: tuple[str, ...] = ()
    form: str | None = None
    rows: str | None = None
    derivative: str | None = None
    variation: str | None = None
    real: str = "double"
    outputs: tuple[str, ...] = ()
    batch: int | None = None
    fma: bool = False
    geometry: str = "runtime"
    matrices: str = "orthonormal"

    @property
    def of_joints(self) -> tuple[str, ...]:
        """Those of the outputs that are routines of joints; empty for `OUTPUTS` where none is asked for."""
        return tuple(name for name in self.outputs if name not in ATTITUDES)

    @property
    def of_attitudes(self) -> tuple[str, ...]:
        """Those of the outputs that are routines of attitudes."""
        return tuple(name for name in ATTITUDES if name in self.outputs)

    @property
    def has_joints(self) -> bool:
        """Whether routines of joints are asked for."""
        return bool(self.of_joints) or not self.outputs
