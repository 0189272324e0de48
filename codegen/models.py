"""From a variant to its symbolic model, and from the model to the cheapest program that is known."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from importlib import resources

import codegen
from codegen.cache import kept
from codegen.errors import Mistake, SpecificationError, nearest
from codegen.ir.lower import Part, Prices, SymbolicOutput, definition_notation, lower, notation
from codegen.ir.lower.lowering import Choose
from codegen.ir.lower.record import Records, fingerprint, replayed
from codegen.ir.lower.search import Choice, Graph, searched
from codegen.ir.program import Program
from codegen.mechanics import frames
from codegen.mechanics.derivation import AS_IT_STANDS, Derivation
from codegen.mechanics.formulation import Formulation, formulation
from codegen.mechanics.joints import BASIC, JOINTS, PAIRS
from codegen.mechanics.places import places
from codegen.passes.pipeline import shorten
from codegen.spec.joints import JointType
from codegen.spec.request import Variant
from codegen.spec.selection import incompatibilities
from flopcount.count import count

PRICES = Prices()
"""What the search minimises: the number of operations."""

STARTS = range(2)
"""Seeds from which the search starts where nothing is on record."""


@cache
def records() -> Records:
    """The choices that a long search found for the routines of the library (``make search``)."""
    content = resources.files(codegen).joinpath("records.json").read_text(encoding="utf-8")
    found: Records = json.loads(content)
    return found


_FOUND: dict[str, list[Choice]] = {}
"""Choices that this process has searched: equal joints of a scene have equal graphs."""


def choices_for(graph: Graph, outputs: Sequence[int]) -> list[Choice]:
    """Choose among the ways to evaluate nodes: what is on record, or the best that a short search finds."""
    key = fingerprint(graph, outputs)
    record = records().get(key)
    if record is not None:
        return [replayed(graph, outputs, record)]
    if key not in _FOUND:
        _FOUND[key] = searched(graph, outputs, STARTS)
    return _FOUND[key]


@dataclass(frozen=True)
class Model:
    """The symbolic model of one variant: mechanics' result, from which programs are lowered."""

    joint: JointType
    variant: Variant
    form: Formulation
    derivation: Derivation

    def outputs(self, names: Iterable[str]) -> tuple[SymbolicOutput, ...]:
        """Derive the named quantities."""
        return tuple(self.derivation.quantity(name) for name in names)

    def text(self, names: Iterable[str]) -> str:
        """Write the blocks of the named quantities in the notation of the papers."""
        lines = [
            f"{symbol} = {definition_notation(str(symbol), definition, self.form.aliases)}"
            for symbol, definition in self.form.stages.items()
        ]
        for output in self.outputs(names):
            lines.append(f"{output.name} {output.shape[0]}x{output.shape[1]}")
            lines += [f"  [{b.row},{b.column}] = {notation(b.expression, self.form.aliases)}" for b in output.blocks]
        return "\n".join(lines) + "\n"

    def program(self, names: Iterable[str]) -> Program:
        """Lower the named quantities to one simplified program; it is kept between runs."""
        wanted = tuple(names)
        lowered = replace(self.variant, geometry="runtime")  # what depends on it alone is split off later
        return kept(("program", lowered, wanted), lambda: self.lowered(self.outputs(wanted)))

    def lowered(
        self,
        outputs: tuple[SymbolicOutput, ...],
        is_substituted: bool | None = None,
        choose: Choose | None = None,
    ) -> Program:
        """Lower any outputs in the stages of this model to one simplified program, the cheapest that is found.

        Args:
            outputs: what to evaluate.
            is_substituted: whether the joint relation takes the place of the rotation matrices; by default where the
                derivative is substituted, but never in ``phi`` and ``branch``.
            choose: among the ways to evaluate them; what is on record, or a search.
        """
        programs = self.programs(outputs, is_substituted, choose or choices_for)
        return min(programs, key=lambda program: count(program).total)

    def programs(
        self, outputs: tuple[SymbolicOutput, ...], is_substituted: bool | None, choose: Choose
    ) -> list[Program]:
        """Lower any outputs in each of the ways that are chosen; see `lowered`."""
        arguments = frames.arguments(self.joint, self.form.coordinates, self.form.row_count)
        inputs = frames.inputs(self.form.coordinates, self.form.row_count)
        parts = self._parts(outputs, is_substituted)
        return [shorten(program) for program in lower(arguments, inputs, parts, PRICES, choose)]

    def _parts(self, outputs: tuple[SymbolicOutput, ...], is_substituted: bool | None) -> list[Part]:
        """Outputs by the frames they are written in, in the order in which they come."""
        inserted = bool(self.form.substitution) if is_substituted is None else is_substituted
        groups: dict[bool, list[SymbolicOutput]] = {}
        for output in outputs:
            groups.setdefault(inserted and output.name not in AS_IT_STANDS, []).append(output)
        return [Part(places(self.form, self.variant, key), tuple(group)) for key, group in groups.items()]


def joint_type(name: str) -> JointType:
    """Find a joint in the catalogue or among the trn x rot pairs.

    Raises:
        SpecificationError: there is none of that name.
    """
    known = {**JOINTS, **PAIRS, **{joint.name: joint for joint in BASIC.values()}}
    if name not in known:
        raise SpecificationError(
            [Mistake(f"joint {name}", "there is no such joint", nearest(name, {**JOINTS, **PAIRS}))]
        )
    return known[name]


def model(variant: Variant) -> Model:
    """Run the first two stages for a variant.

    Raises:
        SpecificationError: the joint is unknown or has no such variant.
    """
    joint = joint_type(variant.joint)
    mistakes = incompatibilities(joint, variant)
    if mistakes:
        raise SpecificationError(mistakes)
    form = formulation(joint, variant)
    return Model(joint, variant, form, Derivation(form))
