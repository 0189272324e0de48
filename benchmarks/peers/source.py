"""Source text of a candidate: one function with the arguments and outputs of our routine."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

from benchmarks.peers.work import Work


@dataclass(frozen=True, slots=True)
class Source:
    """A translation unit that defines ``symbol``.

    Attributes:
        language: ``c`` or ``c++``.
        text: of the file.
        includes: folders of headers that it needs.
    """

    language: str
    text: str
    includes: tuple[str, ...] = ()

    @property
    def ending(self) -> str:
        """Of the file's name."""
        return ".c" if self.language == "c" else ".cpp"


def signature(work: Work, symbol: str, restrict: str = "restrict") -> str:
    """Declaration of the function, as our routine has it."""
    inputs = [f"const double *{restrict} {name}" for name in work.arguments]
    results = [f"double *{restrict} {name}" for name in work.patterns]
    return f"void {symbol}({', '.join(inputs + results)})"


def c_function(work: Work, symbol: str, statements: Iterable[str], prelude: str = "") -> Source:
    """A C function of statements that use the arguments by name."""
    body = "".join(f"    {statement}\n" for statement in statements)
    return Source("c", f"#include <math.h>\n{prelude}\n{signature(work, symbol)}\n{{\n{body}}}\n")


_POWER = re.compile(r"\b(?:std::)?pow\(")
_CAST = re.compile(r"^(?:Scalar|double)\((-?[\d.]+)\)$")


def integer_powers(text: str) -> str:
    """Write out powers with integer exponents; a library call for a square would not be the tool's best."""
    found = _POWER.search(text)
    if not found:
        return text
    base, exponent, end = _power_arguments(text, found.end())
    cast = _CAST.match(exponent)
    power = round(float(cast[1] if cast else exponent))
    base = integer_powers(base)
    product = "*".join(["p"] * abs(power))
    value = f"(1.0/({product}))" if power < 0 else f"({product})"
    written = f"(__extension__ ({{ const double p = {base}; {value}; }}))"
    return text[: found.start()] + written + integer_powers(text[end:])


def _power_arguments(text: str, start: int) -> tuple[str, str, int]:
    """Base, exponent and the place after the closing parenthesis."""
    depth, comma = 0, -1
    for k in range(start, len(text)):
        if text[k] == "(":
            depth += 1
        elif text[k] == "," and depth == 0:
            comma = k
        elif text[k] == ")":
            if depth == 0:
                return text[start:comma].strip(), text[comma + 1 : k].strip(), k + 1
            depth -= 1
    raise ValueError("unbalanced parentheses in a power")
