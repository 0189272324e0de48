"""The number of cores decides how long a scene takes, and nothing else."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pytest

from codegen.scenes.generate import generate_scene
from codegen.spec.scene import Scene, Wanted
from tests.spec.texts import PENDULUM, scene

DOUBLE_PENDULUM = f"""{PENDULUM}
[[body]]
name = "weight"
mass = 1.0
inertia = [0.1, 0.1, 0.1]
position = [1.5, 0.0, 0.0]
quaternion = [1.0, 0.0, 0.0, 0.0]

[[joint]]
name = "ball"
type = "ball"
bodies = ["bar", "weight"]
point = [1.0, 0.0, 0.0]
"""


def made_on(cores: int, mechanism: Scene, home: Path, patch: pytest.MonkeyPatch) -> Mapping[str, bytes]:
    """The package of a scene, with nothing kept from before."""
    patch.setattr(os, "sched_getaffinity", lambda _: set(range(cores)), raising=False)
    patch.setenv("XDG_CACHE_HOME", str(home))
    return generate_scene(mechanism)


def test_a_package_has_the_same_bytes_however_many_cores_made_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mechanism = replace(scene(DOUBLE_PENDULUM), wanted=Wanted(("phi", "phi_q")))
    one, several = (made_on(cores, mechanism, tmp_path / str(cores), monkeypatch) for cores in (1, 3))
    assert one == several
    assert any(b"columns of the ground left out" in content for content in one.values())
