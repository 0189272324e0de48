"""How tests run the command, in this process or in one of its own, and look at folders before and after."""

from __future__ import annotations

import io
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path

import pytest

from codegen.cli import main

REPOSITORY = Path(__file__).resolve().parents[2]
GENERATED = REPOSITORY / "generated"
COMMAND = [sys.executable, "-m", "codegen"]
SMALL = ("generate", "ball", "--form", "conventional", "--variation", "body", "--outputs", "phi")
"""The smallest request: one routine."""


_CACHES = tempfile.TemporaryDirectory(prefix="jointgen-caches-")


@dataclass(frozen=True)
class Result:
    """What a command left behind."""

    exit_code: object
    stdout: str
    stderr: str


def invoke(*arguments: str | Path) -> Result:
    """Run the command in this process; an exception that it lets through is a traceback to its user."""
    out, err = io.StringIO(), io.StringIO()
    before = sys.argv
    sys.argv = ["jointgen", *map(str, arguments)]
    try:
        with redirect_stdout(out), redirect_stderr(err), pytest.raises(SystemExit) as leaving:
            main()
    finally:
        sys.argv = before
    return Result(leaving.value.code, out.getvalue(), err.getvalue())


def empty_cache() -> str:
    """A folder for what a command keeps, with nothing in it."""
    return tempfile.mkdtemp(dir=_CACHES.name)


def spawn(*arguments: str | Path, **variables: str) -> subprocess.Popen[str]:
    """Start the command in a process group of its own, with its output in pipes and nothing kept from other runs."""
    return subprocess.Popen(
        [*COMMAND, *map(str, arguments)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=REPOSITORY,
        env={**os.environ, "XDG_CACHE_HOME": empty_cache(), **variables},
        start_new_session=True,
    )


def finish(process: subprocess.Popen[str], timeout: float = 600.0) -> tuple[int, str, str]:
    """Wait for the command; give exit code, stdout and stderr."""
    out, err = process.communicate(timeout=timeout)
    return process.returncode, out, err


def refused(result: Result) -> list[str]:
    """The mistakes of a command that must have been refused, one a line; its manners are checked."""
    assert result.exit_code == 2, result
    assert result.stdout == ""
    lines = result.stderr.splitlines()
    assert lines
    for line in lines:
        assert line.strip()
        assert "Traceback" not in line
    assert len(set(lines)) == len(lines), "a mistake is told once"
    return lines


def snapshot(folder: Path) -> Mapping[str, tuple[bytes, int, int]]:
    """Content, time of change and inode of everything in a folder, however deep."""
    return {
        path.relative_to(folder).as_posix(): (
            path.read_bytes() if path.is_file() else b"",
            path.lstat().st_mtime_ns,
            path.lstat().st_ino,
        )
        for path in sorted(folder.rglob("*"))
    }


def contents(folder: Path) -> dict[str, bytes]:
    """Content of every file in a folder."""
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}
