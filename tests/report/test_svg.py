"""What every figure has in common: text that a reader sees as it is meant."""

from __future__ import annotations

import re
from pathlib import Path

from matplotlib.figure import Figure

from codegen.report.svg import drawn

ROOT = Path(__file__).parents[2]


def labels(svg: str) -> list[str]:
    return re.findall(r">([^<>]+)</text>", svg)


def line(xs: list[float], title: str = "") -> str:
    def draw(figure: Figure) -> None:
        axis = figure.subplots()
        axis.semilogx(xs, range(len(xs)))
        axis.set_title(title)
        axis.set_yticks([])

    return drawn(draw, 4.0, 3.0)


def test_powers_of_ten_are_labelled_as_they_are_read() -> None:
    assert {"10⁻⁶", "10⁻⁴", "0.01", "1", "100", "10⁴"} <= set(labels(line([1e-6, 1e4])))


def test_a_short_axis_has_labels_between_powers_too() -> None:
    assert {"1", "2", "5", "10"} == set(labels(line([1.0, 10.0])))


def test_a_dollar_in_a_name_is_a_dollar() -> None:
    assert "a $x^2$ b" in labels(line([1.0, 1e3], "a $x^2$ b"))


def test_no_figure_of_the_repository_shows_mathematical_markup() -> None:
    figures = [path for folder in ("docs", "benchmarks", "generated") for path in (ROOT / folder).rglob("*.svg")]
    assert len(figures) > 15
    assert [path.name for path in figures if any("\\math" in label for label in labels(path.read_text()))] == []
