"""What the first line of a CSV of poses says of the order and the units of its columns, where it says anything."""

from __future__ import annotations

import re
from pathlib import Path

from codegen.errors import Mistake

_TURNS = {"roll": "X", "pitch": "Y", "yaw": "Z"}
_QUATERNION = re.compile(r"q?_?([wxyz])")
_ENTRY = re.compile(r"r_?([0-3])_?([0-3])")


def is_pose(line: str) -> bool:
    """Whether a line holds numbers, so that it is a pose and no line of names."""
    try:
        return bool([float(word) for word in line.split(",")])
    except ValueError:
        return False


def heading_mistakes(file: Path, attitude: str) -> list[Mistake]:
    """Find names of columns that contradict what is read from them.

    Args:
        file: a CSV that can be read.
        attitude: as the routines take it.
    """
    with file.open(encoding="utf-8") as lines:
        names = [word.strip().strip('"').lower() for word in next(lines, "").split(",")]
    position, turn = names[:3], names[3:]
    told = []
    if sorted(position) == ["x", "y", "z"] and position != ["x", "y", "z"]:
        told.append((f"gives positions as {' '.join(position)}", "give x y z"))
    if attitude == "matrix":
        told += _of_matrix(turn)
    elif attitude == "quaternion":
        told += _of_quaternion(turn)
    else:
        told += _of_angles(turn, attitude)
    return [Mistake(f"{file}: line 1", what, remedy) for what, remedy in told]


def _of_matrix(names: list[str]) -> list[tuple[str, str]]:
    entries = [match.groups() for match in map(_ENTRY.fullmatch, names) if match]
    if len(entries) < len(names) or [place[::-1] for place in entries] == sorted(place[::-1] for place in entries):
        return []
    return [("does not give the matrix column by column", "give its first column, then the others")]


def _of_quaternion(names: list[str]) -> list[tuple[str, str]]:
    letters = "".join(match[1] for match in map(_QUATERNION.fullmatch, names) if match)
    if sorted(letters) != sorted("wxyz") or letters == "wxyz":
        return []
    return [(f"gives the quaternion as {' '.join(letters)}", "give w x y z")]


def _of_angles(names: list[str], attitude: str) -> list[tuple[str, str]]:
    told = []
    letters = "".join(_TURNS.get(name, "?") for name in names)
    if sorted(letters) == sorted("XYZ") and letters != attitude.upper():
        what = f"gives turns in the order {' '.join(names)}, and the routines take {attitude}"
        told.append((what, "give them in that order, or choose another attitude under [output]"))
    if any("deg" in name for name in names):
        told.append(("gives degrees", "give rad"))
    return told
