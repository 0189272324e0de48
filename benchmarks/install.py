"""Install a lock; where that fails, install what can be installed and say what is missing.

``python benchmarks/install.py PYTHON LOCK``: PYTHON is the interpreter of the environment to fill. The lock names every
package with its hashes, so that single packages need no resolution. Packages of the project itself must be there.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

OPTIONAL = (
    "cmeel",
    "cmeel-assimp",
    "cmeel-boost",
    "cmeel-console-bridge",
    "cmeel-eigen",
    "cmeel-octomap",
    "cmeel-qhull",
    "cmeel-tinyxml2",
    "cmeel-urdfdom",
    "cmeel-zlib",
    "coal",
    "eigenpy",
    "glfw",
    "libcoal",
    "libpinocchio",
    "mujoco",
    "mujoco-core",
    "mujoco-studio",
    "pin",
    "pyopengl",
    "symengine",
    "symforce",
    "symforce-sym",
    "wrenfold",
)
"""Packages without which the benchmark still runs."""


def entries(lock: str) -> dict[str, str]:
    """Package -> its lines in the lock."""
    found: dict[str, str] = {}
    name = ""
    for line in lock.splitlines(keepends=True):
        if line[0].isalnum():
            name = line.split("==")[0]
            found[name] = line
        elif line.startswith("    --hash"):
            found[name] += line
    return found


def install(python: str, requirements: Path, *options: str) -> subprocess.CompletedProcess[str]:
    """Install a requirements file with hashes."""
    command = [python, "-m", "pip", "install", "-q", "--require-hashes", *options, "-r", str(requirements)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def main(python: str, lock: str) -> int:
    """Install the lock; exit code 1 if a package of the project is missing."""
    if install(python, Path(lock)).returncode == 0:
        return 0
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        for name, lines in entries(Path(lock).read_text()).items():
            single = Path(folder) / "requirements.txt"
            single.write_text(lines)
            done = install(python, single, "--no-deps")
            if done.returncode:
                errors = [line for line in done.stderr.splitlines() if line.startswith("ERROR")]
                said = (errors or ["pip fails"])[-1]
                print(f"{name} is not installed: {said}", file=sys.stderr)
                failed |= name not in OPTIONAL
    return failed


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
