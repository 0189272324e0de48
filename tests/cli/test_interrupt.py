"""Whatever interrupts the writing leaves the previous output as it was, or the new one whole, and nothing else."""

from __future__ import annotations

import os
import shutil
import signal
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from codegen import output
from codegen.errors import OutputError

from .runs import SMALL, contents, finish, invoke, snapshot, spawn
from .terminal import CTRL_C, Terminal

OLD = {"manifest.json": b'{"generator": {}, "functions": []}', "c/src/old.c": b"old"}
NEW = {"manifest.json": b'{"generator": {}, "functions": [], "new": 1}', "c/src/new.c": b"new", "c/more.h": b"h"}
STEPS = (
    (Path, "mkdir"),
    (Path, "write_bytes"),
    (os, "rename"),
    (os, "replace"),
    (tempfile, "mkdtemp"),
    (shutil, "rmtree"),
)
"""Calls that change the disk: an interruption may come before each of them, or just behind."""
MOST = 20
"""More steps than a replacement takes."""


class Interruption:
    """Counts the calls of `STEPS` and raises at one of them, before or behind what it does."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, number: int, behind: bool, error: BaseException) -> None:
        self.calls, self.number, self.behind, self.error = 0, number, behind, error
        self.name = ""
        self.stop: Callable[[], None] = self.interrupt
        for owner, name in STEPS:
            monkeypatch.setattr(owner, name, self.watched(getattr(owner, name)))

    def interrupt(self) -> None:
        raise self.error

    def watched(self, call: Callable[..., Any]) -> Callable[..., Any]:
        def step(*arguments: Any, **options: Any) -> Any:
            self.calls += 1
            mine = self.calls == self.number
            if mine:
                self.name = call.__name__
            if mine and not self.behind:
                self.stop()
            result = call(*arguments, **options)
            if mine:
                self.stop()
            return result

        return step


@pytest.mark.parametrize("behind", [False, True], ids=["before", "behind"])
@pytest.mark.parametrize("has_previous", [True, False], ids=["replaced", "new"])
def test_an_interruption_at_any_step_leaves_one_package_whole(
    has_previous: bool, behind: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    broken = []
    for number in range(1, MOST):
        folder = tmp_path / str(number)
        folder.mkdir()
        if has_previous:
            output.replace(folder / "package", OLD)
        with monkeypatch.context() as patched:
            interruption = Interruption(patched, number, behind, KeyboardInterrupt())
            outcome = _outcome(folder / "package")
        step = f"{interruption.name}, call {number}"
        if outcome != ("interrupted" if interruption.calls >= number else "done"):
            broken.append(f"{step}: {outcome}")
        if contents(folder / "package") not in ([OLD, NEW] if has_previous else [{}, NEW]):
            broken.append(f"{step}: the package is lost")
        if [path.name for path in folder.iterdir()] not in ([], ["package"]) and interruption.name != "rmtree":
            broken.append(f"{step}: a temporary folder is left")
    assert broken == []


@pytest.mark.skipif(sys.platform != "linux", reason="folders are exchanged in one step on Linux only")
@pytest.mark.parametrize("behind", [False, True], ids=["before", "behind"])
def test_a_process_killed_at_any_step_leaves_one_package_whole(behind: bool, tmp_path: Path) -> None:
    for number in range(1, MOST):
        folder = tmp_path / str(number)
        output.replace(folder / "package", OLD)
        child = os.fork()
        if not child:
            _killed_at(number, behind, folder / "package")
        os.waitpid(child, 0)
        assert contents(folder / "package") in (OLD, NEW), number


def _killed_at(number: int, behind: bool, target: Path) -> None:
    """Replace a package in this process and end it, by a kill at a step."""
    monkeypatch = pytest.MonkeyPatch()
    interruption = Interruption(monkeypatch, number, behind, KeyboardInterrupt())
    interruption.stop = lambda: os.kill(os.getpid(), signal.SIGKILL)
    output.replace(target, NEW)
    os._exit(0)


def _outcome(target: Path) -> str:
    try:
        output.replace(target, NEW)
    except KeyboardInterrupt:
        return "interrupted"
    except OutputError as error:
        return str(error)
    return "done"


def test_a_full_disk_is_told_and_leaves_the_previous_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for number in range(1, MOST):
        folder = tmp_path / str(number)
        folder.mkdir()
        output.replace(folder / "package", OLD)
        before = snapshot(folder)
        with monkeypatch.context() as patched:
            interruption = Interruption(patched, number, False, OSError(28, "No space left on device"))
            try:
                output.replace(folder / "package", NEW)
            except OutputError as error:
                assert "cannot be written (No space left on device); name another directory" in str(error)
                if interruption.name != "rmtree":
                    assert snapshot(folder) == before
            else:
                assert interruption.calls < number or interruption.name == "rmtree"


@pytest.mark.parametrize("moment", ["0/6", "[1-6]/6", "[3-6]/6", "[5-6]/6", "6/6"])
def test_ctrl_c_leaves_the_previous_package_and_no_process(moment: str, tmp_path: Path) -> None:
    target = tmp_path / "package"
    assert invoke(*SMALL, "-o", target).exit_code == 0
    before = contents(target)
    terminal = Terminal("generate", "ball", "--outputs", "phi,phi_q", "-o", target)
    assert terminal.wait_for(rf"generating .*\b{moment}\b")
    terminal.press(CTRL_C)
    code = terminal.finish()
    assert "Traceback" not in terminal.shown, terminal.shown
    if contents(target) == before:
        assert code == 1
        assert "jointgen: interrupted; nothing was written" in terminal.shown
    else:
        assert code == 0
        assert " files" in terminal.shown
    assert [path.name for path in tmp_path.iterdir()] == ["package"]
    _wait_until_gone(terminal.process.pid)


def _wait_until_gone(group: int) -> None:
    """Wait until no process of a group is left; what has ended is there until the system has taken note of it."""
    limit = time.monotonic() + 10.0
    while True:
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return
        assert time.monotonic() < limit, "a process was left behind"
        time.sleep(0.05)


def test_ctrl_c_before_the_work_starts_writes_nothing(tmp_path: Path) -> None:
    for delay in (0.05, 0.2, 0.4):
        process = spawn("generate", "ball", "-o", tmp_path / "package")
        time.sleep(delay)
        os.killpg(process.pid, signal.SIGINT)
        assert finish(process)[0] != 0
        assert not list(tmp_path.iterdir())
