"""A request for routines: joint, form and options, validated all at once.

Two routines that differ in an option have different symbols; the defaults leave no trace in them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from codegen.errors import Mistake, SpecificationError, nearest
from codegen.spec.joints import JointType

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
        point: axes of the three rows that hold two points together in the parametric form: ``body`` i, as S1 has them,
            or ``world``. Along a joint axis that moves with body i they stay in axes of body i.
    """

    joint: str
    form: str
    rows: str | None
    derivative: str = "exact"
    variation: str = "body"
    geometry: str = "runtime"
    matrices: str = "orthonormal"
    point: str = "body"

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


def incompatibilities(joint: JointType, variant: Variant) -> list[Mistake]:
    """Say why a joint has no such variant; nothing where it has."""
    if variant.form == "conventional":
        return _conventional_incompatibilities(joint, variant)
    mistakes = []
    if variant.rows == "quaternion" and joint.rotations != 3:
        mistakes.append(
            Mistake(
                f"{joint.name} --rows quaternion",
                f"quaternion rows need three rotational freedoms, {joint.name} has {joint.rotations}",
                "use --rows regular, or a joint with rot3 such as ball",
            )
        )
    if variant.variation == "world" and variant.derivative == "substituted":
        mistakes.append(
            Mistake(
                f"{joint.name} --variation world",
                "the substituted derivative exists in body axes only (SPEC S1.2)",
                "use --variation body, or --derivative exact",
            )
        )
    return mistakes


def _conventional_incompatibilities(joint: JointType, variant: Variant) -> list[Mistake]:
    if not joint.conventional:
        what = f"{joint.name} exists in the parametric form only"
        return [Mistake(f"{joint.name} --form conventional", what, "use --form parametric")]
    mistakes = []
    if variant.rows is not None:
        mistakes.append(
            Mistake(
                f"{joint.name} --rows {variant.rows}",
                "the conventional form has no choice of rows",
                "leave --rows out, or use --form parametric",
            )
        )
    if variant.derivative == "substituted" and not joint.is_screw:
        mistakes.append(
            Mistake(
                f"{joint.name} --derivative substituted",
                f"the conventional {joint.name} has only the exact derivative",
                "use --derivative exact, or --form parametric",
            )
        )
    return mistakes


def distinct_rows(joint: JointType) -> tuple[str, ...]:
    """The sets of rows that differ for this joint: ``table4`` is ``regular`` where nothing rotates."""
    return ("regular", "table4") if joint.rotations else ("regular",)


def library_variants(joint: JointType) -> tuple[Variant, ...]:
    """The variants of the committed library: see the README."""
    conventional = [
        Variant(joint.name, "conventional", None, "exact", variation) for variation in VARIATIONS if joint.conventional
    ]
    parametric = [
        Variant(joint.name, "parametric", rows, derivative)
        for rows in distinct_rows(joint)
        for derivative in DERIVATIVES
    ]
    return (*conventional, *parametric)


def selected_variants(
    options: Options, library: Mapping[str, JointType], pairs: Mapping[str, JointType]
) -> tuple[Variant, ...]:
    """Choose the variants that the options ask for.

    An option that is left out ranges over the library's values; one that is given is taken as it is, also where the
    library does not have it (quaternion rows, pairs).

    Raises:
        SpecificationError: unknown names, or options that do not go together; all of them at once.
    """
    known = {**library, **pairs}
    mistakes = [
        Mistake(f"joint {name}", "there is no such joint", nearest(name, known))
        for name in options.joints
        if name not in known
    ]
    mistakes += _unknown_values(options)
    if mistakes:
        raise SpecificationError(mistakes)
    joints = [known[name] for name in dict.fromkeys(options.joints)] or list(library.values())
    variants: list[Variant] = []
    for joint in joints:
        found, problems = _of_joint(joint, options)
        variants += found
        if not found:
            mistakes += problems
    if mistakes and (options.joints or not variants):
        raise SpecificationError(dict.fromkeys(mistakes))
    return tuple(replace(variant, geometry=options.geometry, matrices=options.matrices) for variant in variants)


def _unknown_values(options: Options) -> list[Mistake]:
    choices: Iterable[tuple[str, str | None, tuple[str, ...]]] = (
        ("--form", options.form, FORMS),
        ("--rows", options.rows, ROWS),
        ("--derivative", options.derivative, DERIVATIVES),
        ("--variation", options.variation, VARIATIONS),
        ("--real", options.real, REALS),
        ("--geometry", options.geometry, GEOMETRIES),
        ("--matrices", options.matrices, MATRICES),
        *(("--outputs", output, ASKED) for output in options.outputs),
    )
    return _unknown_batch(options.batch) + [
        Mistake(name, f'there is no "{value}"', nearest(value, known))
        for name, value, known in choices
        if value is not None and value not in known
    ]


def _unknown_batch(batch: int | None) -> list[Mistake]:
    if batch is None or batch in BATCHES:
        return []
    sizes = ", ".join(str(size) for size in BATCHES)
    return [Mistake("--batch", f"there are no groups of {batch} joints", f"known: {sizes}")]


def _of_joint(joint: JointType, options: Options) -> tuple[list[Variant], list[Mistake]]:
    """Candidates of one joint: those that exist, and why the others do not."""
    forms = (options.form,) if options.form else _forms(joint, options)
    found: list[Variant] = []
    problems: list[Mistake] = []
    for variant in dict.fromkeys(variant for form in forms for variant in _of_form(joint, form, options)):
        mistakes = incompatibilities(joint, variant)
        problems += mistakes
        if not mistakes:
            found.append(variant)
    return found, problems


def _forms(joint: JointType, options: Options) -> tuple[str, ...]:
    """Forms meant where none is named: rows and the substituted derivative are the parametric form's."""
    if options.rows or not joint.conventional or (options.derivative == "substituted" and not joint.is_screw):
        return ("parametric",)
    return FORMS


def _of_form(joint: JointType, form: str, options: Options) -> list[Variant]:
    if form == "conventional":
        derivative = options.derivative or "exact"
        variations = (options.variation,) if options.variation else VARIATIONS
        return [Variant(joint.name, form, options.rows, derivative, variation) for variation in variations]
    rows = (options.rows,) if options.rows else distinct_rows(joint)
    derivatives = (options.derivative,) if options.derivative else DERIVATIVES
    if options.variation == "world" and not options.derivative:
        derivatives = ("exact",)
    if not joint.rotations:
        rows = tuple(dict.fromkeys("regular" if choice == "table4" else choice for choice in rows))
    return [
        Variant(joint.name, form, choice, derivative, options.variation or "body")
        for choice in rows
        for derivative in derivatives
    ]
