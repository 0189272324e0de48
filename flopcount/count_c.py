"""A second counter, independent of the first: it reads the text of emitted C.

It knows nothing of programs: it takes the text apart into tokens and counts binary and unary operators and calls of the
mathematical functions. A call of another routine of the same text counts as that routine does.
"""

from __future__ import annotations

import re
from collections import Counter

from flopcount.counts import Counts

_FUNCTION = re.compile(r"^void\s+(\w+)\s*\([^)]*\)\s*\{(.*?)^\}", re.MULTILINE | re.DOTALL)
_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
_LITERAL = re.compile(r"JG_REAL\([^)]*\)")
_INDEX = re.compile(r"\[[^\[\]]*\]")
_TOKEN = re.compile(r"[A-Za-z_]\w*|\d+(?:\.\d*)?(?:[eE][+-]?\d+)?|[-+*/(),;=&]")
_MATHEMATICAL = {
    "jg_fma": "fma",
    "jg_sqrt": "sqrt",
    "jg_sin": "sin",
    "jg_cos": "cos",
    "jg_sincos": "sincos",
    "jg_atan2": "atan2",
    "jg_abs": "abs",
    "jg_select": "select",
}
_BINARY = {"+": "add", "-": "add", "*": "mul", "/": "div"}


def count_c(source: str) -> dict[str, Counts]:
    """Count the operations of every function defined in a C source.

    Returns:
        Function name -> counts, calls of functions of the same source included.
    """
    text = _COMMENT.sub(" ", source)
    bodies = {match[1]: match[2] for match in _FUNCTION.finditer(text)}
    counts: dict[str, Counts] = {}
    for name in bodies:
        _count_function(name, bodies, counts)
    return counts


def _count_function(name: str, bodies: dict[str, str], counts: dict[str, Counts]) -> Counts:
    if name not in counts:
        tokens = _tokens(bodies[name])
        kinds = Counter(kind for kind in map(_kind, [";", *tokens], tokens) if kind)
        total = Counts(**kinds)
        for token in tokens:
            if token in bodies:
                total += _count_function(token, bodies, counts)
        counts[name] = total
    return counts[name]


def _tokens(body: str) -> list[str]:
    """Tokens of the arithmetic; declarations of pointers and indices are no arithmetic."""
    plain = _LITERAL.sub(" 0 ", body)
    while _INDEX.search(plain):
        plain = _INDEX.sub(" ", plain)
    statements = [statement for statement in plain.split(";") if "*const" not in statement]
    return _TOKEN.findall(";".join(statements))


def _kind(before: str, token: str) -> str | None:
    if token in _MATHEMATICAL:
        return _MATHEMATICAL[token]
    if token not in _BINARY:
        return None
    is_binary = before == ")" or before[0].isalnum() or before[0] == "_"
    if is_binary:
        return _BINARY[token]
    return "neg" if token == "-" else None
