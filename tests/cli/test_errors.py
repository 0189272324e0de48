"""Bad input is refused: exit code 2, one line a mistake with its remedy, nothing written, previous output as it was."""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from .runs import GENERATED, SMALL, invoke, refused, snapshot

UNKNOWN = {
    "joint": (("revolut",), 'joint revolut: there is no such joint; did you mean "revolute"? known: '),
    "pair": (("trn4_rot1",), 'joint trn4_rot1: there is no such joint; did you mean "trn'),
    "form": (("ball", "--form", "parametrik"), '--form: there is no "parametrik"; did you mean "parametric"? known: '),
    "rows": (("ball", "--rows", "quaternions"), 'did you mean "quaternion"? known: regular, table4, quaternion'),
    "derivative": (("ball", "--derivative", "exactly"), '--derivative: there is no "exactly"; did you mean "exact"?'),
    "variation": (("ball", "--variation", "word"), '--variation: there is no "word"; did you mean "world"?'),
    "real": (("ball", "--real", "flaot"), '--real: there is no "flaot"; did you mean "float"? known: double, float'),
    "geometry": (("ball", "--geometry", "prepare"), '--geometry: there is no "prepare"; did you mean "prepared"?'),
    "output": (("ball", "--outputs", "phi,gama"), '--outputs: there is no "gama"; did you mean "gamma"?'),
    "batch": (("ball", "--batch", "3"), "--batch: there are no groups of 3 joints; known: 2, 4, 8, 16"),
    "batch of nothing": (("ball", "--batch", "0"), "--batch: there are no groups of 0 joints; known: 2, 4, 8, 16"),
    "batch in words": (("ball", "--batch", "four"), '--batch: "four" is not a whole number; give one of 2, 4, 8, 16'),
    "dump": (("ball", "--dump", "programs"), '--dump: there is no stage "programs"; did you mean "program"?'),
    "far": (("xyz",), "joint xyz: there is no such joint; known: revolute, translational,"),
}
INCOMPATIBLE = {
    "quaternion rows of a revolute": ("revolute", "--rows", "quaternion"),
    "rows of the conventional form": ("revolute", "--form", "conventional", "--rows", "table4"),
    "substituted in world variation": ("revolute", "--derivative", "substituted", "--variation", "world"),
    "substituted conventional": ("revolute", "--form", "conventional", "--derivative", "substituted"),
    "conventional pair": ("trn2_rot3", "--form", "conventional"),
    "one of two joints": ("ball", "revolute", "--rows", "quaternion"),
}


@pytest.fixture
def previous(tmp_path: Path) -> Iterator[Path]:
    """A folder with an earlier package in it, which the test must leave as it is, and nothing beside it."""
    target = tmp_path / "package"
    assert invoke(*SMALL, "-o", target).exit_code == 0
    before = snapshot(tmp_path)
    yield target
    assert snapshot(tmp_path) == before


@pytest.mark.parametrize("case", UNKNOWN)
def test_an_unknown_name_is_told_with_the_nearest_known_one(case: str, previous: Path) -> None:
    arguments, words = UNKNOWN[case]
    (line,) = refused(invoke("generate", *arguments, "-o", previous))
    assert words in line


@pytest.mark.parametrize("case", INCOMPATIBLE)
def test_options_that_do_not_go_together_are_told_with_a_remedy(case: str, previous: Path) -> None:
    (line,) = refused(invoke("generate", *INCOMPATIBLE[case], "-o", previous))
    assert re.fullmatch(r"\w+ --\w+ \w+: .+; (use|leave) .+", line)


def test_all_unknown_names_are_told_at_once(previous: Path) -> None:
    wrong = ("--form", "x", "--rows", "y", "--derivative", "z", "--variation", "u", "--real", "v", "--geometry", "w")
    lines = refused(invoke("generate", "revolut", "bal", *wrong, "--outputs", "phi,psi,chi", "-o", previous))
    places = [line.split(":")[0] for line in lines]
    options = ["--form", "--rows", "--derivative", "--variation", "--real", "--geometry", "--outputs", "--outputs"]
    assert places == ["joint revolut", "joint bal", *options]


def test_all_incompatible_options_are_told_at_once(previous: Path) -> None:
    lines = refused(invoke("generate", "revolute", "planar", "ball", "--rows", "quaternion", "-o", previous))
    assert [line.split(":")[0] for line in lines] == ["revolute --rows quaternion", "planar --rows quaternion"]


def test_all_mistakes_about_one_joint_are_told_at_once(previous: Path) -> None:
    wrong = ("revolute", "--form", "conventional", "--rows", "table4", "--derivative", "substituted")
    lines = refused(invoke("generate", *wrong, "-o", previous))
    assert [line.split(":")[0] for line in lines] == ["revolute --rows table4", "revolute --derivative substituted"]


@pytest.mark.parametrize(
    "arguments",
    [("generate", "--bogus"), ("generate", "-o"), ("bogus",), ("flops", "--bogus"), ("joints", "surplus")],
    ids=" ".join,
)
def test_a_wrong_command_line_is_one_line(arguments: tuple[str, ...], tmp_path: Path) -> None:
    assert len(refused(invoke(*arguments))) == 1


def test_a_file_is_no_target(tmp_path: Path) -> None:
    target = tmp_path / "file"
    target.write_text("mine")
    (line,) = refused(invoke(*SMALL, "-o", target))
    assert line == f"{target}: is a file, not a directory; name another directory with -o"
    assert target.read_text() == "mine"
    assert list(tmp_path.iterdir()) == [target]


@pytest.mark.parametrize("below", ["/proc/package", "{file}/package", "{file}/deep/package", "{long}", "{root}/{long}"])
def test_a_target_that_cannot_be_written_is_told(below: str, tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_text("mine")
    target = below.format(file=file, root=tmp_path, long="a" * 300)
    (line,) = refused(invoke(*SMALL, "-o", target))
    assert line.startswith(f"{target}: ")
    assert line.endswith("; name another directory with -o")
    assert list(tmp_path.iterdir()) == [file]


@pytest.mark.parametrize(
    "manifest",
    [None, "", "{", "[]", '{"generator": {"name": "jointgen"}', '{"name": "other"}'],
    ids=["none", "empty", "cut off", "a list", "half", "of another program"],
)
def test_a_folder_that_is_not_ours_is_left_alone(manifest: str | None, tmp_path: Path) -> None:
    target = tmp_path / "package"
    target.mkdir()
    (target / "precious.txt").write_text("mine")
    if manifest is not None:
        (target / "manifest.json").write_text(manifest)
    before = snapshot(tmp_path)
    (line,) = refused(invoke(*SMALL, "-o", target))
    assert "is not empty and holds no manifest.json of jointgen; remove it, or name another directory" in line
    assert snapshot(tmp_path) == before


@pytest.mark.parametrize("functions", ["", ', "functions": 3', ', "functions": [{}]', ', "functions": null'])
def test_a_damaged_manifest_of_ours_is_no_traceback(functions: str, tmp_path: Path) -> None:
    target = tmp_path / "package"
    target.mkdir()
    (target / "manifest.json").write_text('{"generator": {"name": "jointgen"}' + functions + "}")
    result = invoke(*SMALL, "-o", target)
    assert result.exit_code == 0 or refused(result)


def test_an_empty_folder_is_a_target(tmp_path: Path) -> None:
    assert invoke(*SMALL, "-o", tmp_path / "new/deep").exit_code == 0
    (tmp_path / "empty").mkdir()
    assert invoke(*SMALL, "-o", tmp_path / "empty").exit_code == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["empty", "new"]


def test_a_link_to_a_folder_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "link").symlink_to("folder")
    assert invoke(*SMALL, "-o", tmp_path / "link").exit_code == 0
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "folder/manifest.json").is_file()


def test_every_output_asked_for_is_there(tmp_path: Path) -> None:
    assert invoke(*SMALL[:-1], "phi,all", "-o", tmp_path / "package").exit_code == 0
    manifest = (tmp_path / "package/manifest.json").read_text()
    assert '"symbol": "jg_ball_conventional_phi"' in manifest
    assert '"symbol": "jg_ball_conventional_all"' in manifest


@pytest.mark.parametrize(
    "partial",
    [SMALL[1:], SMALL[2:], ("--outputs", "phi"), ("--form", "conventional", "--outputs", "phi")],
    ids=["a joint", "a form and a variation", "outputs", "a form and outputs"],
)
def test_a_partial_request_does_not_replace_the_whole_library(partial: tuple[str, ...], tmp_path: Path) -> None:
    target = tmp_path / "library"
    target.mkdir()
    shutil.copy(GENERATED / "manifest.json", target)
    before = snapshot(tmp_path)
    (line,) = refused(invoke("generate", *partial, "-o", target))
    assert re.search(r"holds \d+ other functions, which this request would remove; name another directory", line)
    assert snapshot(tmp_path) == before
