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


def compiler_version() -> str:
    """Name and version of the compiler, as it tells them.

    Raises:
        SpecificationError: there is none.
    """
    done = subprocess.run([compiler(), "--version"], capture_output=True, text=True, check=False)
    return next(iter(done.stdout.splitlines()), "an unknown compiler")


def compile_sources(sources: Sequence[Path], program: Path, flags: Sequence[str] = C_FLAGS) -> None:
    """Compile C sources to a program.

    Raises:
        SpecificationError: the compiler refuses them.
    """
    command = [compiler(), *flags, *map(str, sources), "-o", str(program), "-lm"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        said = next(iter(done.stderr.strip().splitlines()), "without a word")
        raise SpecificationError([Mistake(sources[0].name, f"does not compile: {said}", "check the compiler")])
