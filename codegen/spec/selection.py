"""The variants that a request means: those that a joint has, and why it has no others; all mistakes at once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from codegen.errors import Mistake, SpecificationError, nearest
from codegen.spec.joints import JointType
from codegen.spec.request import (
    ASKED,
    BATCHES,
    DERIVATIVES,
    FORMS,
    GEOMETRIES,
    MATRICES,
    REALS,
    ROWS,
    VARIATIONS,
    Options,
    Variant,
)


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
    return [
        Variant(joint.name, form, choice, derivative, options.variation or "body")
        for choice in rows
        for derivative in derivatives
    ]
