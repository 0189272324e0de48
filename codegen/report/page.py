"""One page of results that needs no other file: texts, tables, pictures and animations, folder by folder.

Input: findings. Output: HTML. Pictures are images, never part of the page, and text stays text.
"""

from __future__ import annotations

import base64
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from markdown_it import MarkdownIt
from markdown_it.token import Token

from codegen.emit.environment import render
from codegen.report.findings import Finding


@dataclass(frozen=True, slots=True)
class _Section:
    """A folder on the page: texts are HTML, the other pictures are file name -> address."""

    title: str
    texts: tuple[str, ...]
    pictures: dict[str, str]
    summary: tuple[tuple[str, str], ...]
    animation: str


def page(found: Sequence[Finding], version: str) -> str:
    """Write the page.

    Args:
        found: what it shows, in this order.
        version: of jointgen.
    """
    return render("report/page.html.j2", version=version, sections=[_section(finding) for finding in found])


def _section(finding: Finding) -> _Section:
    addresses = {name: _address(svg) for name, svg in finding.pictures.items()}
    shown: set[str] = set()
    texts = tuple(_html(text, addresses, shown) for text in finding.texts)
    return _Section(
        finding.title,
        texts,
        {name: address for name, address in addresses.items() if name not in shown},
        tuple(_flat(finding.summary or {})),
        finding.animation,
    )


def _address(svg: str) -> str:
    return f"data:image/svg+xml;base64,{base64.b64encode(svg.encode()).decode()}"


def _html(text: str, pictures: Mapping[str, str], shown: set[str]) -> str:
    """Render Markdown; its pictures come from the folder, and links into the folder are left out."""
    parser = MarkdownIt("commonmark", {"html": False}).enable("table")
    tokens = parser.parse(text)
    for token in tokens:
        if token.type in ("heading_open", "heading_close"):
            token.tag = f"h{min(int(token.tag[1]) + 2, 6)}"
        token.children = _kept(token.children or [], pictures, shown) if token.children else token.children
    return str(parser.renderer.render(tokens, parser.options, {}))


def _kept(tokens: Sequence[Token], pictures: Mapping[str, str], shown: set[str]) -> list[Token]:
    kept, inside = [], []
    for token in tokens:
        if token.type == "image":
            name = str(token.attrs["src"]).removeprefix("./")
            if name not in pictures:
                continue
            shown.add(name)
            token.attrs["src"] = pictures[name]
        if token.type == "link_open":
            inside.append(str(token.attrs["href"]).startswith(("https://", "http://")))
        if token.type not in ("link_open", "link_close") or inside[-1]:
            kept.append(token)
        if token.type == "link_close":
            inside.pop()
    return kept


def _flat(values: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, str]]:
    """The numbers of a summary, line by line."""
    for name, value in values.items():
        words = f"{before}{name.replace('_', ' ')}"
        if isinstance(value, Mapping):
            yield from _flat(value, f"{words}: ")
        elif isinstance(value, list):
            yield words, "; ".join(_cell(entry) for entry in value)
        else:
            yield words, _cell(value)


def _cell(value: Any) -> str:
    if isinstance(value, Mapping):
        return ", ".join(f"{name} {_cell(entry)}" for name, entry in value.items())
    if isinstance(value, list):
        return " ".join(map(_cell, value))
    return f"{value:.6g}" if isinstance(value, float) else str(value)
