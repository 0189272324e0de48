"""``report`` puts everything that folders hold on one page that needs nothing else, and nothing on it runs as code."""

from __future__ import annotations

import json
from html.parser import HTMLParser
from pathlib import Path

import pytest

from .runs import GENERATED, invoke, refused

SVG = '<svg xmlns="http://www.w3.org/2000/svg"><title>curve</title></svg>'


class Page(HTMLParser):
    """Tags with their attributes, and the text of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.words = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data: str) -> None:
        self.words += data

    def named(self, tag: str) -> list[dict[str, str | None]]:
        return [attributes for name, attributes in self.tags if name == tag]


@pytest.fixture
def results(tmp_path: Path) -> Path:
    """A benchmark, and a run below it."""
    folder = tmp_path / "results"
    (folder / "run").mkdir(parents=True)
    text = "# Times\n\n| sets | ns |\n|---|---|\n| 5 | 7.25 |\n\n![chart](curve.svg) [more](other.md) <b>raw</b>\n"
    (folder / "results.md").write_text(text)
    (folder / "results.json").write_text("{}")
    (folder / "curve.svg").write_text(SVG)
    (folder / "run/summary.json").write_text(json.dumps({"rows": 17, "joint": "a*/<script>", "drift": {"m": 1e-12}}))
    (folder / "run/plot.svg").write_text(SVG)
    (folder / "run/animation.html").write_text('<p>"moves"</p><script>play()</script>')
    return folder


def made(folder: Path, target: Path) -> Page:
    result = invoke("report", folder, "-o", target)
    assert (result.exit_code, result.stderr) == (0, "")
    return Page(target.read_text())


def test_texts_tables_pictures_and_runs_are_on_the_page(results: Path, tmp_path: Path) -> None:
    page = made(results, tmp_path / "report.html")
    for words in ("Times", "7.25", "rows", "17", "drift: m", "1e-12", "results/run"):
        assert words in page.words
    assert len(page.named("img")) == 2
    assert len(page.named("section")) == 2


def test_the_page_needs_no_other_file(results: Path, tmp_path: Path) -> None:
    page = made(results, tmp_path / "report.html")
    for _, attributes in page.tags:
        for name in ("src", "href"):
            address = attributes.get(name) or "#"
            assert address.startswith(("#", "data:image/svg+xml;base64,"))


def test_nothing_of_the_results_runs_as_code_on_the_page(results: Path, tmp_path: Path) -> None:
    page = made(results, tmp_path / "report.html")
    assert page.named("script") == page.named("b") == []
    assert "a*/<script>" in page.words
    (frame,) = page.named("iframe")
    assert frame["sandbox"] == "allow-scripts", "the animation runs by itself, without access to the page"
    assert frame["srcdoc"] == '<p>"moves"</p><script>play()</script>'


def test_the_library_is_reported_with_its_tables(tmp_path: Path) -> None:
    page = made(GENERATED, tmp_path / "report.html")
    assert "S1 Table 7 at a glance" in page.words
    assert len(page.named("img")) == len(list(GENERATED.rglob("*.svg")))


def test_the_same_results_give_the_same_bytes(results: Path, tmp_path: Path) -> None:
    for name in ("one.html", "two.html"):
        made(results, tmp_path / name)
    assert (tmp_path / "one.html").read_bytes() == (tmp_path / "two.html").read_bytes()


def test_what_cannot_be_reported_is_said_and_leaves_the_old_page(results: Path, tmp_path: Path) -> None:
    target = tmp_path / "report.html"
    target.write_text("old")
    assert len(refused(invoke("report", tmp_path / "no", tmp_path / "nor", "-o", target))) == 2
    (results / "run/summary.json").write_text("{")
    assert "summary.json: cannot be read" in refused(invoke("report", results, "-o", target))[0]
    (tmp_path / "empty").mkdir()
    assert "holds no results" in refused(invoke("report", tmp_path / "empty", "-o", target))[0]
    assert target.read_text() == "old"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["empty", "report.html", "results"]


def test_a_folder_in_the_place_of_the_page_is_refused(results: Path, tmp_path: Path) -> None:
    (tmp_path / "report.html").mkdir()
    result = invoke("report", results, "-o", tmp_path / "report.html")
    assert result.exit_code == 2
