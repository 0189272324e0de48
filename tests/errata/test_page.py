"""docs/errata.md holds the numbers that the other tests judge."""

import re

from . import render
from .misprints import EQUATIONS


def page() -> str:
    return render.PAGE.read_text(encoding="utf-8")


def test_page_is_current() -> None:
    """If not: .venv/bin/python -m tests.errata.render."""
    assert page() == render.rendered(page())


def test_page_has_every_block_once() -> None:
    assert [match[2] for match in render.BLOCK.finditer(page())] == list(render.BLOCKS)


def test_page_says_what_is_printed_and_what_is_correct_of_every_equation() -> None:
    for equation in {misprint.equation for misprint in EQUATIONS}:
        assert re.search(rf"^\| (\(31\), )?{re.escape(equation)}", page(), re.MULTILINE), equation


def test_page_shows_no_right_form_as_wrong() -> None:
    rows = [line.split(" | ") for line in page().splitlines() if line.startswith("| (") and "off by" not in line]
    numbers = [row for row in rows if len(row) == 5]
    assert len(numbers) == len(EQUATIONS)
    assert all(row[-1] == "< 1e-10 |" and not row[-2].startswith("<") for row in numbers)
