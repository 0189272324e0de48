"""C text compiled into a library in memory."""

from __future__ import annotations

import ctypes
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

import codegen
from codegen.emit.environment import render
from codegen.emit.package import banner
from codegen.errors import InternalError
from codegen.measure.compile import compiler

_FLAGS = ("-std=c99", "-O2")


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
    with tempfile.TemporaryDirectory() as folder:
        text, binary = Path(folder) / "source.c", Path(folder) / "source.so"
        text.write_text(source)
        header = render("c/jg_real.h.j2", banner=banner(codegen.__version__), real="double", fma=False, batch=None)
        for name, content in {"jg_real.h": header, **headers}.items():
            (Path(folder) / name).write_text(content)
        command = [compiler(), *flags, "-fPIC", "-shared", str(text), "-o", str(binary), "-lm"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            raise InternalError(f"generated code does not compile: {done.stderr}")
        return ctypes.CDLL(str(binary))
