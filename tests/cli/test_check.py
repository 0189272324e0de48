"""``generate --check`` compares and writes nothing; the committed library is current, byte for byte."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import pytest

from .runs import GENERATED, SMALL, contents, invoke, snapshot


@pytest.fixture
def package(tmp_path: Path) -> Iterator[Path]:
    target = tmp_path / "package"
    assert invoke(*SMALL, "-o", target).exit_code == 0
    yield target
    assert [path.name for path in tmp_path.iterdir()] in ([], ["package"])


def test_the_committed_library_is_current(tmp_path: Path) -> None:
    """Made into another folder, of programs lowered by the processes of this run, each with a hash seed of its own."""
    made = invoke("generate", "-o", tmp_path / "library")
    assert (made.exit_code, made.stderr) == (0, "")
    functions = json.loads((GENERATED / "manifest.json").read_text())["functions"]
    assert made.stdout == f"{tmp_path / 'library'}: {len(functions)} functions in {len(contents(GENERATED))} files\n"
    fresh, committed = contents(tmp_path / "library"), contents(GENERATED)
    assert sorted(fresh) == sorted(committed)
    assert [name for name in fresh if fresh[name] != committed[name]] == []


def test_a_current_package_is_exit_code_0(package: Path) -> None:
    before = snapshot(package.parent)
    result = invoke(*SMALL, "-o", package, "--check")
    assert (result.exit_code, result.stdout, result.stderr) == (0, f"{package} is current\n", "")
    assert snapshot(package.parent) == before


@pytest.mark.parametrize("damage", ["stale", "missing", "not generated any more", "no folder"])
def test_a_package_that_is_not_current_is_exit_code_1_and_its_files_are_named(damage: str, package: Path) -> None:
    source = package / "c/src/ball_conventional.c"
    if damage == "stale":
        source.write_bytes(source.read_bytes() + b"\n")
    elif damage == "missing":
        source.unlink()
    elif damage == "not generated any more":
        (package / "c/src/old.c").write_text("")
        source = package / "c/src/old.c"
    else:
        for path in sorted(package.rglob("*"), reverse=True):
            path.unlink() if path.is_file() else path.rmdir()
        package.rmdir()
    before = snapshot(package.parent)
    result = invoke(*SMALL, "-o", package, "--check")
    assert (result.exit_code, result.stdout) == (1, "")
    lines = result.stderr.splitlines()
    assert lines[-1] == f"{package} is not current: run jointgen generate"
    assert f"{source}: {'missing' if damage == 'no folder' else damage}" in lines
    assert damage == "no folder" or len(lines) == 2
    assert snapshot(package.parent) == before


def test_generating_again_changes_no_byte(package: Path) -> None:
    before = contents(package)
    assert invoke(*SMALL, "-o", package).exit_code == 0
    assert contents(package) == before


def test_other_options_are_another_package(package: Path) -> None:
    assert invoke(*SMALL[:-1], "gamma", "-o", package, "--check").exit_code == 1
