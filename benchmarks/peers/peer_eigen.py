"""Hand-written C++ with Eigen: fixed-size matrices, one file a joint in ``eigen_routines``."""

from __future__ import annotations

from pathlib import Path

from benchmarks.peers.eigen import eigen_include
from benchmarks.peers.source import Source
from benchmarks.peers.work import Work

NAME = "eigen"
PACKAGE = "cmeel-eigen"
FORMS = ("by hand", "by hand scalar", "by hand inlined")
"""As it is; vectorisation left to the compiler; everything unrolled and inlined into the routine."""

_MACROS = {
    "by hand": {},
    "by hand scalar": {"EIGEN_DONT_VECTORIZE": ""},
    "by hand inlined": {"EIGEN_UNROLLING_LIMIT": "1000", "INLINED": "__attribute__((flatten))"},
}

_FOLDER = Path(__file__).parent / "eigen_routines"


def write(work: Work, form: str, symbol: str) -> Source:
    """Give the routine; nothing is generated."""
    text = (_FOLDER / f"{work.joint}.cpp").read_text()
    text = text.replace('#include "blocks.hpp"', (_FOLDER / "blocks.hpp").read_text().replace("#pragma once\n", ""))
    for name, value in _MACROS[form].items():
        text = f"#ifndef {name}\n#define {name} {value}\n#endif\n{text}"
    return Source("c++", text.replace("ROUTINE(", f"{symbol}("), (str(eigen_include()),))
