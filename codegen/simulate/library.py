"""C text compiled into a library that is loaded; it is kept between runs, so that none is compiled twice."""

from __future__ import annotations

import ctypes
import platform
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from types import MappingProxyType

import codegen
from codegen.cache import kept_file
from codegen.emit.environment import render
from codegen.emit.package import banner
from codegen.errors import InternalError
from codegen.measure.compile import compiler, compiler_version

_FLAGS = ("-std=c99", "-O1")
"""Straight-line code is compiled in two thirds of the time of -O2, and at most a few percent slower."""


def library(
    source: str, headers: Mapping[str, str] = MappingProxyType({}), flags: Sequence[str] = _FLAGS
) -> ctypes.CDLL:
    """Compile a source and load it.

    Args:
        source: C99 that may include ``jg_real.h``.
        headers: further ones, and another ``jg_real.h``: name -> text.
        flags: of the compiler; those of a shared library are added.

    Raises:
        SpecificationError: there is no C compiler.
    """
    header = render("c/jg_real.h.j2", banner=banner(codegen.__version__), real="double", fma=False, batch=None)
    texts = {"source.c": source, "jg_real.h": header, **headers}
    what = (compiler_version(), _processor() if "-march=native" in flags else "", tuple(flags), texts)
    return ctypes.CDLL(str(kept_file(what, ".so", lambda: _compiled(texts, flags))))


def _compiled(texts: Mapping[str, str], flags: Sequence[str]) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        text, binary = Path(folder) / "source.c", Path(folder) / "source.so"
        for name, content in texts.items():
            (Path(folder) / name).write_text(content)
        command = [compiler(), *flags, "-fPIC", "-shared", str(text), "-o", str(binary), "-lm"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            raise InternalError(f"generated code does not compile: {done.stderr}")
        return binary.read_bytes()


@cache
def _processor() -> str:
    """What a library that is compiled for this processor may use."""
    known = Path("/proc/cpuinfo")
    lines = known.read_text().splitlines() if known.exists() else [platform.processor()]
    return next((line for line in lines if line.startswith(("flags", "Features"))), "".join(lines[:1]))
