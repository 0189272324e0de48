"""From a platform to its routines: derivation, lowering, passes, the last of which orders and fuses."""

from __future__ import annotations

from codegen.cache import kept
from codegen.emit.platform_subject import PlatformSubject
from codegen.emit.routine import Routine
from codegen.ir.program import Program
from codegen.mechanics.velocity.model import velocity_program
from codegen.passes import simplify
from codegen.passes.alternate import alternate
from codegen.passes.contract_fma import contract_fma
from codegen.spec.platform import Platform
from flopcount.count import count

EQUATIONS = "S3 Eqs. 9 to 50, corrected (docs/platform.md)"


def program(platform: Platform, names: tuple[str, ...], real: str = "double", is_symbolic: bool = False) -> Program:
    """The simplified program of quantities of a platform.

    Args:
        platform: with its variant and how it takes the attitude.
        names: quantities that the variant offers.
        real: ``double`` or ``float``: decides what is rounding.
        is_symbolic: whether the joints are arguments too.
    """
    return kept(("platform", platform, names, real, is_symbolic), lambda: _program(platform, names, real, is_symbolic))


def _program(platform: Platform, names: tuple[str, ...], real: str, is_symbolic: bool) -> Program:
    found = alternate(simplify(velocity_program(platform, names, real, is_symbolic)))
    return contract_fma(found) if platform.wanted.fma else found


def routine(platform: Platform, output: str, names: tuple[str, ...], real: str = "double") -> Routine:
    """A routine of a platform.

    Args:
        platform: the platform.
        output: its name: that of the quantity, or ``all``.
        names: what it evaluates.
        real: number type.
    """
    found = program(platform, names, real)
    return Routine(PlatformSubject(platform), output, found, count(found), EQUATIONS)


def wanted(platform: Platform) -> dict[str, tuple[str, ...]]:
    """Say which quantities each routine evaluates: those asked for one by one, and all of them at once."""
    names = platform.wanted.offered
    return {name: (name,) for name in names} | ({"all": names} if len(names) > 1 else {})
