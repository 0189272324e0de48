"""Compile C with the machine's compiler."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path

from codegen.errors import Mistake, SpecificationError

C_FLAGS = ("-std=c99", "-O2")


def compiler() -> str:
    """Find a C compiler.

    Raises:
        SpecificationError: there is none.
    """
    for name in ("cc", "gcc", "clang"):
        found = shutil.which(name)
        if found:
            return found
    raise SpecificationError([Mistake("compiler", "there is no C compiler (cc, gcc or clang)", "install gcc")])


def compile_program(source: Path, program: Path, flags: Sequence[str] = C_FLAGS) -> None:
    """Compile one C source to a program.

    Raises:
        SpecificationError: the compiler refuses it.
    """
    command = [compiler(), *flags, str(source), "-o", str(program), "-lm"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise SpecificationError(
            [Mistake(source.name, f"does not compile: {done.stderr.strip().splitlines()[0]}", "check the compiler")]
        )
