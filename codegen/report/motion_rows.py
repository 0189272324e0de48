"""What is drawn of a run: rows of bodies and joints, with a panel for each quantity."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from codegen.simulate.trajectory import Array, Trajectory
from codegen.spec.scene import COORDINATE_UNITS, Scene

STILL = 1e-7
"""A component that changes by less than this part of the greatest change of its kind does not move."""

_TRANSLATIONS = (("r", "position", "m"), ("v", "velocity", "m/s"), ("a", "acceleration", "m/s²"))
_TURNS = (("w", "angular velocity", "rad/s"), ("al", "angular acceleration", "rad/s²"))
_COORDINATES = (("coordinate", "alpha", ""), ("rate", "alphadot", "/s"))
_EFFORT = "effort of the drive"
_REACTIONS = (("reaction force", "f", "N"), ("reaction moment", "m", "N m"))
_FORCES = {"m": "N", "rad": "N m", "m or rad": "N or N m"}
CHAINS = (
    tuple(words for _, words, _ in _TRANSLATIONS),
    tuple(words for _, words, _ in _TURNS),
    tuple(words for words, _, _ in _COORDINATES),
    (_EFFORT,),
    *((heading,) for heading, _, _ in _REACTIONS),
)
"""Headings in order; each but the first of a chain is the rate of the one before."""


@dataclass(frozen=True, slots=True, eq=False)
class Panel:
    """Curves over one pair of axes.

    Attributes:
        unit: of all of them.
        curves: name, number of the line style, [n] values.
    """

    unit: str
    curves: tuple[tuple[str, int, Array], ...]


@dataclass(frozen=True, slots=True, eq=False)
class Row:
    """Panels of one body or joint, by the heading of their column."""

    name: str
    panels: dict[str, Panel]


def body_rows(trajectory: Trajectory) -> list[Row]:
    """Give the components that move, body by body; bodies at rest have no row."""
    r, w = trajectory.r, trajectory.w
    travels, turns = np.ptp(r, axis=0), np.max(np.abs(w), axis=0)
    moving = {"translations": travels > STILL * np.max(travels, initial=0.0)}
    moving["turns"] = turns > STILL * np.max(turns, initial=0.0)
    rows = []
    for k, body in enumerate(trajectory.bodies):
        panels = {}
        for kind, quantities in (("translations", _TRANSLATIONS), ("turns", _TURNS)):
            axes = np.flatnonzero(moving[kind][k])
            for name, words, unit in quantities if len(axes) else ():
                values = getattr(trajectory, name)
                curves = tuple((f"{body}.{name}{'xyz'[i]}", int(i), values[:, k, i]) for i in axes)
                panels[words] = Panel(unit, curves)
        if panels:
            rows.append(Row(body, panels))
    return rows


def joint_rows(trajectory: Trajectory, scene: Scene | None) -> list[Row]:
    """Give coordinates that change, efforts and reactions: a row for each joint and unit, reactions in the first."""
    rows = []
    for joint in dict.fromkeys((*trajectory.alpha, *trajectory.reaction)):
        own = list(_coordinate_rows(trajectory, joint, scene)) if joint in trajectory.alpha else []
        panels = dict(_reaction_panels(trajectory, joint))
        if own:
            own[0].panels.update(panels)
        rows += own or ([Row(joint, panels)] if panels else [])
    return rows


def _coordinate_rows(trajectory: Trajectory, joint: str, scene: Scene | None) -> Iterator[Row]:
    alpha = trajectory.alpha[joint]
    effort = trajectory.effort.get(joint, np.zeros((len(trajectory.t), 0)))
    units, driven = _units(joint, scene, alpha.shape[1], effort.shape[1])
    names = [f"{joint}.effort{n + 1 if len(driven) > 1 else ''}" for n in range(len(driven))]
    efforts = dict(zip(driven, zip(names, effort.T, strict=True), strict=True))
    for unit in dict.fromkeys(units):
        of_unit = [k for k, other in enumerate(units) if other == unit]
        panels = dict(_motion_panels(trajectory, joint, unit, [k for k in of_unit if np.ptp(alpha[:, k]) > 0]))
        if curves := tuple((name, k, values) for k, (name, values) in efforts.items() if k in of_unit):
            panels[_EFFORT] = Panel(_FORCES[unit], curves)
        if panels:
            yield Row(joint, panels)


def _reaction_panels(trajectory: Trajectory, joint: str) -> Iterator[tuple[str, Panel]]:
    """The components that are not zero, beside the largest of all joints."""
    for number, (heading, letter, unit) in enumerate(_REACTIONS):
        part = slice(3 * number, 3 * number + 3)
        largest = max((float(np.max(np.abs(v[:, part]))) for v in trajectory.reaction.values()), default=0.0)
        values = trajectory.reaction.get(joint, np.zeros((1, 6)))[:, part]
        acting = [k for k in range(3) if np.max(np.abs(values[:, k])) > STILL * largest]
        if acting:
            yield heading, Panel(unit, tuple((f"{joint}.{letter}{'xyz'[k]}", k, values[:, k]) for k in acting))


def _units(joint: str, scene: Scene | None, count: int, drives: int) -> tuple[tuple[str, ...], list[int]]:
    """Unit of each coordinate, and the numbers of those that are driven; without a scene, the first ones."""
    if scene is None:
        return ("m or rad",) * count, list(range(drives))
    found = next(one for one in scene.joints if one.name == joint)
    driven = [k for k, coordinate in enumerate(found.coordinates) if coordinate.drive is not None]
    return COORDINATE_UNITS[found.type], driven if drives else []


def _motion_panels(trajectory: Trajectory, joint: str, unit: str, moving: list[int]) -> Iterator[tuple[str, Panel]]:
    for heading, name, suffix in _COORDINATES if moving else ():
        values = getattr(trajectory, name)[joint]
        words = " or ".join(one + suffix for one in unit.split(" or "))
        yield heading, Panel(words, tuple((f"{joint}.{name}{k + 1}", k, values[:, k]) for k in moving))
