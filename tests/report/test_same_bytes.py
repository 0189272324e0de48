"""Pictures of a run are the same bytes under every hash seed."""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

CODE = """
import hashlib
from codegen.report.animation import page
from codegen.report.motion_plot import plot
from tests.report.runs import tumbling
scene, trajectory = tumbling(8, ("one", "two"))
for text in (plot(trajectory, "title", scene), page(scene, trajectory)):
    print(hashlib.sha256(text.encode()).hexdigest())
"""


def digests(seed: str) -> str:
    environment = {**os.environ, "PYTHONHASHSEED": seed}
    command = [sys.executable, "-c", CODE]
    return subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=True).stdout


def test_plot_and_animation_are_the_same_bytes_under_two_hash_seeds():
    first = digests("1")
    assert len(first.split()) == 2
    assert digests("2") == first
