"""Indices as CasADi functions of pose and joints: what an optimiser of designs needs."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from codegen.emit import casadi
from codegen.platforms.programs import program
from codegen.spec.platform import Platform


def design_function(platform: Platform, name: str, variant: str = "smooth") -> Any:
    """A quantity as a ``casadi.Function`` of pose and joints.

    Args:
        platform: its joints are only the scale of what is rounding.
        name: of the quantity, ``C`` for example.
        variant: ``smooth`` has derivatives everywhere but in singular poses.

    Returns:
        Function of ``o`` [3], the attitude, ``base`` [3, 6] and ``platform`` [3, 6] in m.
    """
    chosen = replace(platform, wanted=replace(platform.wanted, variant=variant))
    found = program(chosen, (name,), is_symbolic=True)
    return casadi.casadi_function(f"jg_{platform.name}_{name}_design", found)
