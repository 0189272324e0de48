"""What the routines of one source file of a package are of: a joint in one variant, or attitudes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from codegen.emit.attitude_subject import ATTITUDE
from codegen.spec.request import Variant


@dataclass(frozen=True, slots=True)
class UnitSubject:
    """What the routines of one source file are of.

    Attributes:
        header: name of the header, without ending; several source files may share it.
        file_stem: name of the source file, without ending.
        topic: of the header, as ``Constraint routines of the ball joint``.
        object: what one call is about: ``joint`` or ``body``.
        options: in words, for the head of the file: before the number type.
        further: options after it.
        stem: start of the symbols.
        record: what the manifest says of it.
        has_externals: whether CasADi externals are written.
    """

    header: str
    file_stem: str
    topic: str
    object: str
    options: tuple[str, ...]
    further: tuple[str, ...]
    stem: str
    record: Mapping[str, Any]
    has_externals: bool

    @property
    def title(self) -> str:
        """Of the header for single calls."""
        return f"{self.topic} between bodies i and j" if self.object == "joint" else self.topic

    @staticmethod
    def of_variant(variant: Variant) -> UnitSubject:
        """A joint in one variant."""
        topic = f"Constraint routines of the {variant.joint} joint"
        options = [f"joint {variant.joint}", f"form {variant.form}"]
        options += [f"rows {variant.rows}"] if variant.rows else []
        options += [f"derivative {variant.derivative}", f"variation {variant.variation}"]
        further = ["matrices raw"] if variant.matrices == "raw" else []
        further += ["geometry prepared"] if variant.geometry == "prepared" else []
        return UnitSubject(
            variant.joint,
            variant.file_stem,
            topic,
            "joint",
            tuple(options),
            tuple(further),
            variant.stem,
            asdict(variant),
            True,
        )

    @staticmethod
    def of_attitudes() -> UnitSubject:
        """Rotation matrices, whatever the joint."""
        name = ATTITUDE
        topic = "Routines of the attitude of a body"
        return UnitSubject(name, name, topic, "body", (name,), (), f"jg_{name}", {"of": name}, False)
