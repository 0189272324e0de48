"""Routines of a scene that are emitted by name only: attitudes mended and judged, and the branch of every joint."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from codegen import output
from codegen.scenes.generate import generate_scene
from codegen.scenes.read import read
from codegen.spec.scene import Scene

from .packages import EXAMPLES, Case, Package

CHECKS = ("branch", "orthonormalise", "check_orthonormal")


def package(scene: Scene, form: str, folder: Path) -> Package:
    files = generate_scene(replace(scene, wanted=replace(scene.wanted, quantities=CHECKS)), form)
    output.replace(folder / "out", files)
    return Package(Case("", CHECKS), folder / "out")


def evaluated(made: Package, **inputs: Any) -> dict[str, Any]:
    library = made.library()
    found = {}
    for entry in made.entries:
        found |= {name: value.ravel() for name, value in library.call(entry["symbol"], inputs).items()}
    return found


def test_loops_over_spatial_attitudes_and_branches(tmp_path: Path) -> None:
    copies = 3
    scene, _ = read(EXAMPLES / "in_line_engine_parametric.toml", copies)
    made = package(scene, "parametric", tmp_path)
    assert all("loops" in entry for entry in made.entries)
    random = np.random.default_rng(3)
    A = Rotation.random(3 * copies, rng=random).as_matrix()
    drifted = A + 1e-9 * random.uniform(-1.0, 1.0, A.shape)
    alpha = random.uniform(-3.0, 3.0, 4 * copies)
    found = evaluated(made, A=drifted.transpose(0, 2, 1).ravel(), alpha=alpha)
    U, _, V = np.linalg.svd(drifted)
    np.testing.assert_allclose(found["orthonormalise"].reshape(-1, 3, 3).transpose(0, 2, 1), U @ V, rtol=0, atol=1e-14)
    cofactors = np.linalg.det(drifted)[:, None, None] * np.linalg.inv(drifted).transpose(0, 2, 1)
    defects = np.hypot(np.linalg.norm(drifted - cofactors, axis=(1, 2)), np.linalg.det(drifted) - 1.0)
    np.testing.assert_allclose(found["check_orthonormal"], defects, atol=1e-14)
    crank, rod, piston = (A[k::3] for k in range(3))
    pairs = ((np.eye(3)[None], crank), (crank, rod), (rod, piston))
    for k, (A_i, A_j) in enumerate(pairs):
        turn = Rotation.from_rotvec(alpha[k::4, None] * [0.0, 0.0, 1.0]).as_matrix()
        frames = [np.array([[float(x) for x in row] for row in marker.axes]) for marker in markers_of(scene, k)]
        relative = turn.transpose(0, 2, 1) @ frames[0].T @ np.swapaxes(A_i, 1, 2) @ A_j @ frames[1]
        expected = (np.trace(relative, axis1=1, axis2=2) - 1.0) / 2.0
        np.testing.assert_allclose(found["branch"][k::4], expected, rtol=0, atol=1e-8)


def markers_of(scene: Scene, joint: int) -> tuple[Any, Any]:
    return scene.joints[joint].marker_i, scene.joints[joint].marker_j


def test_attitudes_and_branches_in_the_plane(tmp_path: Path) -> None:
    scene, _ = read(EXAMPLES / "four_bar.toml")
    made = package(replace(scene, motion="planar"), "parametric", tmp_path)
    random = np.random.default_rng(4)
    angles, alpha = random.uniform(-3.0, 3.0, 3), random.uniform(-3.0, 3.0, 4)
    stretched = np.array([[c, s, -s, c] for c, s in zip(np.cos(angles), np.sin(angles), strict=True)]) * (1.0 + 1e-9)
    found = evaluated(made, A=stretched.ravel(), alpha=alpha)
    np.testing.assert_allclose(found["orthonormalise"].reshape(-1, 4), stretched / (1.0 + 1e-9), rtol=0, atol=1e-15)
    np.testing.assert_allclose(found["check_orthonormal"], 8**0.5 * 1e-9, rtol=1e-6)
    since = angles - [2 * np.arctan2(float(b.quaternion[3]), float(b.quaternion[0])) for b in scene.bodies]
    turns = np.array([since[0], since[1] - since[0], since[2] - since[1]])
    np.testing.assert_allclose(found["branch"][:3], np.cos(turns - alpha[:3]), rtol=0, atol=1e-8)
