"""C text compiled into a library in memory."""

from __future__ import annotations

import ctypes
import subprocess
import tempfile
from pathlib import Path

import codegen
from codegen.emit.environment import render
from codegen.emit.package import banner
from codegen.errors import InternalError
from codegen.measure.compile import compiler

_FLAGS = ("-std=c99", "-O2", "-fPIC", "-shared")


def library(source: str) -> ctypes.CDLL:
    """Compile a source and load it.

    Args:
        source: C99 that may include ``jg_real.h``.

    Raises:
        SpecificationError: there is no C compiler.
    """
    with tempfile.TemporaryDirectory() as folder:
        text, binary = Path(folder) / "source.c", Path(folder) / "source.so"
        text.write_text(source)
        header = render("c/jg_real.h.j2", banner=banner(codegen.__version__), real="double", fma=False, batch=None)
        (Path(folder) / "jg_real.h").write_text(header)
        command = [compiler(), *_FLAGS, str(text), "-o", str(binary), "-lm"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            raise InternalError(f"the equations of motion do not compile: {done.stderr}")
        return ctypes.CDLL(str(binary))
