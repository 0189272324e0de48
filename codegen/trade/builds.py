"""The ways to compile a routine that are measured: number type, lanes, compiler, flags, sines and cosines."""

from __future__ import annotations

import shutil
from dataclasses import replace

from codegen.emit.routine import Routine
from codegen.errors import Mistake, SpecificationError
from codegen.ir.ops import Op
from codegen.measure.routine_builds import NATIVE, SAME_BITS, Build
from codegen.measure.short_trigonometry import DEGREES
from codegen.passes.contract_fma import contract_fma
from codegen.passes.given_trigonometry import given_trigonometry

_FUNCTIONS = frozenset({Op.SIN, Op.COS, Op.SINCOS, Op.ATAN2})
_STRICT_NATIVE = (*NATIVE, *SAME_BITS)

BASE = (Build("double"), Build("float", "float"))
"""What every routine is measured in."""

_FURTHER = (
    Build("double, -O3 native", flags=NATIVE),
    Build("double, --fma, -O3 native", flags=_STRICT_NATIVE, fma=True),
    Build("double, own sin and cos", trigonometry="own"),
    Build("double, sin and cos given", trigonometry="given"),
    Build("double, 4 lanes", lanes=4, flags=_STRICT_NATIVE),
    Build("float, -O3 native", "float", flags=NATIVE),
    Build("float, 8 lanes", "float", lanes=8, flags=_STRICT_NATIVE),
    Build("float, 8 lanes, sin and cos given", "float", lanes=8, flags=_STRICT_NATIVE, trigonometry="given"),
    Build("long double", "long double"),
)
_SHORT = tuple(
    Build(f"double, sin and cos of degree {degree}", trigonometry="short", degree=degree) for degree in DEGREES
)
_CLANG = (
    Build("double, clang", compiler="clang", flags=("-O2", "-ffp-contract=off")),
    Build("double, clang, -O3 native", compiler="clang", flags=NATIVE),
)


def builds(is_full: bool) -> tuple[Build, ...]:
    """Give the builds that this machine can make: all of them, or what every routine is measured in.

    Raises:
        SpecificationError: there is no gcc.
    """
    if shutil.which("gcc") is None:
        raise SpecificationError([Mistake("compiler", "there is no gcc", "install gcc")])
    clang = _CLANG if shutil.which("clang") else ()
    return (*BASE, *_FURTHER, *_SHORT, *clang) if is_full else BASE


def prepared_for(routine: Routine, build: Build) -> Routine | None:
    """Give the routine with the program that a build takes; None where it makes no difference to the routine."""
    program = routine.straight
    if build.fma:
        return replace(routine, program=contract_fma(program))
    if build.trigonometry == "given":
        given = given_trigonometry(program)
        return None if given is program else replace(routine, program=given)
    functions = {instruction.op for instruction in program.instructions} & _FUNCTIONS
    if build.trigonometry == "short":
        return routine if functions - {Op.ATAN2} else None
    return None if build.trigonometry == "own" and not functions else routine
