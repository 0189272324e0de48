"""What an importer returns, and what may be asked of it: a scene, and all that the file holds beside it."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from fractions import Fraction

from codegen.spec.scene import Limit, Scene

LONGEST_NAME = 60
"""Signs in the name of a body or joint."""

_LONGEST_SCENE_NAME = 40

REMEDY = "pip install 'jointgen[import]'"
"""Brings the parsers of the importers."""


@dataclass(frozen=True, slots=True)
class LeftOut:
    """Something in a file that the scene does not model.

    Attributes:
        element: what it is, for example ``collision`` or ``limit: effort, velocity``.
        place: where it stands, for example ``arm.urdf: link "upper arm"``.
        why: why it is left out, or what to do instead.
    """

    element: str
    place: str
    why: str

    def __str__(self) -> str:
        return f"{self.place}: {self.element}: {self.why}"


@dataclass(frozen=True, slots=True)
class Imported:
    """A scene from a file of another program.

    Attributes:
        scene: what is modelled.
        left_out: everything else, in the order of the file.
    """

    scene: Scene
    left_out: tuple[LeftOut, ...]


@dataclass(frozen=True, slots=True)
class Stops:
    """Soft stops that stand for the limits of a joint: N m/rad and N m s/rad, or N/m and N s/m."""

    rotation_stiffness: Fraction
    rotation_damping: Fraction
    translation_stiffness: Fraction
    translation_damping: Fraction

    def limit(self, lower: Fraction | None, upper: Fraction | None, is_rotation: bool) -> Limit:
        """Soft stops at ``lower`` and ``upper``, rad or m."""
        if is_rotation:
            return Limit(lower, upper, self.rotation_stiffness, self.rotation_damping)
        return Limit(lower, upper, self.translation_stiffness, self.translation_damping)


@dataclass(frozen=True, slots=True)
class ImportOptions:
    """How a file is read.

    Attributes:
        stops: soft stops at the limits of the joints; None leaves the limits out.
        keep_fixed: a link that is fixed to another stays a body, with a rigid joint; otherwise the two are one body.
        free_base: the first link of a URDF moves freely; otherwise it is fixed to the ground.
        right_angle: an attitude that is this near to quarter turns is made of quarter turns, rad. Files with 1.5708 for
            a right angle ask for 1e-5.
    """

    stops: Stops | None = None
    keep_fixed: bool = False
    free_base: bool = False
    right_angle: Fraction = Fraction(1, 10**9)


def quoted(name: str) -> str:
    """A name of a file in a message: in quotes, on one line whatever it holds."""
    cut = name if len(name) <= LONGEST_NAME else f"{name[:LONGEST_NAME]}..."
    return json.dumps(cut, ensure_ascii=not cut.isprintable())


def scene_name(name: str | None) -> str:
    """A C identifier out of the name of a robot or model."""
    word = re.sub(r"[^A-Za-z0-9]+", "_", name or "").strip("_")
    return (word if word[:1].isalpha() else f"scene_{word}")[:_LONGEST_SCENE_NAME].rstrip("_")
