"""A run as one HTML file that plays it: no server, no network, no library.

Input: a scene and its trajectory. Output: a page with the numbers as JSON and the player of ``templates/report``.
"""

from __future__ import annotations

import base64
import hashlib
import json
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from codegen.emit.environment import render
from codegen.report.joint_glyphs import GLYPHS
from codegen.report.view import first_view
from codegen.simulate.trajectory import Array, Trajectory
from codegen.spec.scene import GROUND, Scene, Vector

Frames = NDArray[np.intp]
"""Numbers of output times."""

MOST_FRAMES = 600
_MOST_NUMBERS = 300_000
_FEWEST_FRAMES = 100

DIGITS = 5
"""Lengths are kept to 1e-5 of the mechanism's size, quaternions and joint axes to 1e-5."""


def page(scene: Scene, trajectory: Trajectory) -> str:
    """Write the page that plays a run.

    Args:
        scene: as its file has it.
        trajectory: of the scene, in the axes of the file; finite.

    Returns:
        An HTML document.
    """
    script = "".join(render(f"report/animation_{part}.js.j2") for part in ("geometry", "picture", "player"))
    digest = hashlib.sha256(script.encode()).digest()
    return render(
        "report/animation.html.j2",
        name=scene.name,
        notes=list(_notes(trajectory)),
        script=script,
        script_hash=base64.b64encode(digest).decode(),
        data=script_json(page_data(scene, trajectory)),
    )


def page_data(scene: Scene, trajectory: Trajectory) -> dict[str, Any]:
    """Give what the player draws.

    Bodies are numbered, the ground is -1; points are in body axes from the centre of mass, on the ground in the world.
    A pose is x y z of the centre of mass and w x y z of the attitude, each a number where it is constant, else one
    number a frame.
    """
    kept = frames(trajectory)
    number = {GROUND: -1} | {name: k for k, name in enumerate(trajectory.bodies)}
    ends = list(_ends(scene))
    points = _world_points(trajectory, kept, [(number[body], point) for body, point in ends])
    centre = (np.max(points, axis=0) + np.min(points, axis=0)) / 2
    radius = float(np.max(np.linalg.norm(points - centre, axis=1))) or 1.0
    decimals = DIGITS - math.floor(math.log10(radius))
    return {
        "radius": _rounded(radius, decimals),
        "centre": _rounded(centre, decimals),
        "view": _rounded(first_view(scene), DIGITS),
        "glyph": _rounded(_glyph(ends, radius), decimals + 2),
        "t": _rounded(trajectory.t[kept], _time_decimals(trajectory.t)),
        "bodies": [_body(trajectory, kept, k, ends, decimals) for k in range(len(trajectory.bodies))],
        "joints": [
            {"name": joint.name, "type": joint.type}
            | _fixed(joint.bodies, (joint.marker_i.point, joint.marker_j.point), number, decimals)
            | {"axes": _rounded([_floats(m.axes) for m in (joint.marker_i, joint.marker_j)], DIGITS)}
            for joint in scene.joints
        ],
        "springs": [_fixed(spring.bodies, spring.points, number, decimals) for spring in scene.springs],
        "glyphs": {kind: _glyph_strokes(kind) for kind in dict.fromkeys(joint.type for joint in scene.joints)},
    }


def _body(
    trajectory: Trajectory, kept: Frames, k: int, ends: Sequence[tuple[str, Vector]], decimals: int
) -> dict[str, Any]:
    name = trajectory.bodies[k]
    own = [tuple(_rounded(_floats(point), decimals)) for body, point in ends if body == name]
    r, q = trajectory.r[kept, k], _continuous(trajectory.q[kept, k])
    return {"name": name, "points": list(dict.fromkeys(own)), "pose": [*_columns(r, decimals), *_columns(q, DIGITS)]}


def _fixed(bodies: Sequence[str], points: Sequence[Vector], number: Mapping[str, int], decimals: int) -> dict[str, Any]:
    """Where a joint or spring is fixed on its two bodies."""
    return {
        "bodies": [number[name] for name in bodies],
        "points": _rounded([_floats(point) for point in points], decimals),
    }


def _glyph_strokes(kind: str) -> list[dict[str, Any]]:
    return [
        {"side": stroke.side, "filled": stroke.is_filled, "points": _rounded(stroke.points, 3)}
        for stroke in GLYPHS[kind]
    ]


def frames(trajectory: Trajectory) -> Frames:
    """Numbers of the output times that are kept, evenly: at most `MOST_FRAMES`, fewer where there are many bodies."""
    most = max(_FEWEST_FRAMES, min(MOST_FRAMES, _MOST_NUMBERS // (7 * max(1, len(trajectory.bodies)))))
    count = len(trajectory.t)
    return np.unique(np.round(np.linspace(0, count - 1, min(count, most))).astype(np.intp))


def script_json(data: object) -> str:
    """JSON that may stand in a script element: nothing in it ends the element or opens a comment."""
    text = json.dumps(data, separators=(",", ":"), allow_nan=False)
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")


def _notes(trajectory: Trajectory) -> Iterator[str]:
    kept = frames(trajectory)
    if len(kept) < len(trajectory.t):
        yield f"{len(kept)} of {len(trajectory.t)} output times are shown."
    if len(kept) > 1 and trajectory.w.size:
        speed = np.max(np.linalg.norm(trajectory.w[kept], axis=2), axis=1)
        turn = float(np.max(speed[1:] * np.diff(trajectory.t[kept])))
        if turn > math.pi:
            yield f"A body turns by up to {turn / (2 * math.pi):.1f} turns from one frame to the next."


def _ends(scene: Scene) -> Iterator[tuple[str, Vector]]:
    """Bodies and points of joints, then of springs."""
    for joint in scene.joints:
        yield from zip(joint.bodies, (joint.marker_i.point, joint.marker_j.point), strict=True)
    for spring in scene.springs:
        yield from zip(spring.bodies, spring.points, strict=True)


def _world_points(trajectory: Trajectory, kept: Frames, ends: Sequence[tuple[int, Vector]]) -> Array:
    """All points and centres of mass at all frames, [., 3] m; the origin where there are none."""
    found = [trajectory.r[kept].reshape(-1, 3)]
    for body, point in ends:
        s = _floats(point)
        if body < 0:
            found.append(s[None])
        else:
            w, u = trajectory.q[kept, body, :1], trajectory.q[kept, body, 1:]
            twice = 2 * np.cross(u, s)
            found.append(trajectory.r[kept, body] + s + w * twice + np.cross(u, twice))
    points = np.concatenate(found)
    return points if len(points) else np.zeros((1, 3))


def _glyph(ends: Sequence[tuple[str, Vector]], radius: float) -> float:
    """Half the size of a joint, m: small beside the bodies and beside the mechanism."""
    arms = [float(np.linalg.norm(_floats(point))) for body, point in ends if body != GROUND]
    arms = [arm for arm in arms if arm > 1e-3 * radius]
    return min([0.06 * radius, *([0.3 * float(np.median(arms))] if arms else [])])


def _continuous(q: Array) -> Array:
    """Quaternions [n, 4] with signs so that each is near the one before."""
    turns_over = np.sum(q[1:] * q[:-1], axis=1) < 0
    signs = np.cumprod(np.where(turns_over, -1.0, 1.0))
    return np.concatenate([q[:1], q[1:] * signs[:, None]])


def _columns(values: Array, decimals: int) -> list[Any]:
    columns = [_rounded(column, decimals) for column in values.T]
    return [column[0] if len(set(column)) == 1 else column for column in columns]


def _time_decimals(t: Array) -> int:
    span = float(t[-1] - t[0])
    return 6 - math.floor(math.log10(span)) if span > 0 else 6


def _floats(values: Sequence[Any]) -> Array:
    return np.array(values, dtype=np.float64)


def _rounded(values: Any, decimals: int) -> Any:
    """Numbers as JSON has them, nested as they were; whole ones without a point."""
    if isinstance(values, np.ndarray):
        values = values.tolist()
    if isinstance(values, (list, tuple)):
        return [_rounded(value, decimals) for value in values]
    value = round(float(values), decimals)
    return int(value) if value.is_integer() else value
