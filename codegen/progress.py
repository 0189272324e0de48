"""A progress bar on a terminal."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Callable, Iterator


@contextlib.contextmanager
def progress(total: int, words: str, before: str = "") -> Iterator[Callable[[str], None]]:
    """A progress bar on a terminal, silence in a pipe.

    Args:
        total: how often it is told.
        words: what goes on.
        before: what goes on until it is first told, where that is something else.
    """
    if not sys.stderr.isatty():
        yield lambda _: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(before or words, total=total)

        def advance(name: str) -> None:
            bar.update(task, advance=1, description=f"{words} {name}")

        yield advance
