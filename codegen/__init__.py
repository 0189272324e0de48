"""jointgen: specialised constraint routines for multibody mechanisms, derived symbolically.

The pipeline, one way: ``spec`` -> ``mechanics`` (symbolic model) -> ``ir`` (program) -> ``passes`` -> ``emit`` ->
``report``. :mod:`codegen.build` is that pipeline in one place.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import casadi

__version__ = "0.1.0"

__all__ = ["__version__", "casadi_function"]


def casadi_function(joint: str, form: str = "conventional", output: str = "all", **options: str) -> casadi.Function:
    """Build the CasADi function of a joint routine; see :func:`codegen.build.casadi_function`."""
    from codegen import build

    function: Any = build.casadi_function(joint, form, output, **options)
    return function
