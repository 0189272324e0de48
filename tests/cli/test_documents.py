"""The documents: every command that they show is one that the command line takes."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from pathlib import Path

import click
import pytest

from codegen.cli import jointgen

from .runs import REPOSITORY

DOCUMENTS = (
    "README.md",
    "CONTRIBUTING.md",
    *(f"docs/{path.name}" for path in sorted((REPOSITORY / "docs").glob("*.md"))),
)


def commands(document: str) -> Iterator[list[str]]:
    """Arguments of each call of jointgen in the shell blocks of a document."""
    for block in re.findall(r"^```(?:sh|console)\n(.*?)^```", (REPOSITORY / document).read_text(), re.M | re.S):
        for line in block.replace("\\\n", " ").splitlines():
            words = shlex.split(line.removeprefix("$ "), comments=True)
            if words and Path(words[0]).name == "jointgen":
                yield words[1:]


def taken(arguments: list[str]) -> click.Context:
    """Parse a call without running it; an unknown command or option is an error."""
    return jointgen.commands[arguments[0]].make_context(arguments[0], arguments[1:])


@pytest.mark.parametrize("document", DOCUMENTS)
def test_commands_of_a_document_are_taken(document: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(REPOSITORY)
    for arguments in commands(document):
        taken(arguments)


def test_the_readme_names_every_command() -> None:
    text = (REPOSITORY / "README.md").read_text()
    assert {name for name in jointgen.commands if f"jointgen {name}" not in text} == set()
    assert len(list(commands("README.md"))) > 15


def test_an_option_that_does_not_exist_is_found() -> None:
    with pytest.raises(click.UsageError, match="No such option"):
        taken(["simulate", "examples/four_bar.toml", "-o", "run", "--no-such-option"])
