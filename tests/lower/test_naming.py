"""Names survive for readers: valid in C, one value each, with a definition that fits a comment."""

from __future__ import annotations

import random
import re
from functools import cache

from codegen.ir.lower.search import cheapest
from codegen.ir.program import Program
from codegen.passes import simplify
from codegen.spec.request import Variant

from .models import every_variant, laid_out, program_of, random_choice

C_KEYWORDS = frozenset(
    """auto break case char const continue default do double else enum extern float for goto if inline int long register
    restrict return short signed sizeof static struct switch typedef union unsigned void volatile while""".split()  # noqa: SIM905
)
C_IDENTIFIER = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
LONGEST_IDENTIFIER = 63
"""Initial characters of a name that C99 promises to tell apart."""
LONGEST_DEFINITION = 96
"""Columns that a comment leaves to a definition."""


@cache
def programs(variant: Variant) -> tuple[Program, ...]:
    """Programs as lowered: of the start of a search and of choices at random."""
    parts = laid_out(variant)
    choices = [tuple(cheapest(laid.graph, laid.roots, sweeps=0) for laid in parts)]
    source = random.Random(2)
    choices += [tuple(random_choice(laid.graph, source, set()) for laid in parts) for _ in range(1)]
    return tuple(program_of(parts, each) for each in choices)


@every_variant
def test_names_are_identifiers_of_c(variant: Variant) -> None:
    for program in programs(variant):
        names = {instruction.label[0] for instruction in program.instructions if instruction.label}
        assert names
        for name in names | {name for name, _ in program.legend}:
            assert C_IDENTIFIER.fullmatch(name), name
            assert len(name) <= LONGEST_IDENTIFIER, name
            assert name not in C_KEYWORDS


@every_variant
def test_two_values_never_share_a_name_and_index(variant: Variant) -> None:
    for program in programs(variant):
        for stage in (program, simplify(program)):
            labels = [instruction.label for instruction in stage.instructions if instruction.label]
            twice = {label for label in labels if labels.count(label) > 1} if len(labels) != len(set(labels)) else set()
            assert not twice, sorted(twice)[:5]


@every_variant
def test_every_name_has_its_place_in_the_legend(variant: Variant) -> None:
    for program in programs(variant):
        names = {instruction.label[0] for instruction in program.instructions if instruction.label}
        assert names <= {name for name, _ in program.legend}


@every_variant
def test_definitions_fit_a_comment(variant: Variant) -> None:
    for program in programs(variant):
        for name, definition in program.legend:
            assert "*/" not in definition and "/*" not in definition, (name, definition)
            assert definition.isprintable(), (name, definition)
            assert len(definition) <= LONGEST_DEFINITION, (name, definition)


@every_variant
def test_no_name_is_that_of_an_argument(variant: Variant) -> None:
    """A stage may not hide an input of the routine."""
    for program in programs(variant):
        names = {instruction.label[0] for instruction in program.instructions if instruction.label}
        assert not names & {argument.name for argument in program.arguments}
