"""The batch entry for arrays of any strides: groups are gathered, evaluated and spread; arrays stay where they are."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

from codegen.emit.batch import BatchEntry, BatchRoutine
from codegen.emit.declarations import declaration
from codegen.emit.environment import render
from codegen.emit.routine import Parameter, Routine

STRIDED = "strided"
"""Layout: entry (i, k) of pose j of array a at ``[j s[3 a] + i s[3 a + 1] + k s[3 a + 2]]``."""

_WIDTH = 112


def strided_routine(routine: Routine, declared: tuple[Parameter, ...], lanes: int) -> BatchRoutine:
    """Emit the entry of arbitrary strides; its text follows that of `codegen.emit.batch.batch_routine`.

    Args:
        routine: that is evaluated.
        declared: its parameters for one pose.
        lanes: of the kernel.
    """
    symbol = f"{routine.symbol}_batch{lanes}"
    entry = _Strided(f"{symbol}_any", routine.symbol, STRIDED, ("count",), declared, _comment(routine.symbol))
    arrays = [(p, 3 * k, *_shape(p)) for k, p in enumerate(declared)]
    text = render("c/batch_strided.c.j2", symbol=symbol, signature=entry.signature, arrays=arrays)
    return BatchRoutine((entry,), text)


class _Strided(BatchEntry):
    __slots__ = ()

    @property
    def signature(self) -> str:
        leading = ["long count", "const long *strides"]
        return declaration(self.symbol, self.parameters, leading)


def _shape(parameter: Parameter) -> tuple[int, int]:
    """Rows and columns of what is stored; nonzeros are a vector."""
    return (parameter.length, 1) if parameter.layout == "compressed-columns" else parameter.shape


def _comment(scalar: str) -> tuple[str, ...]:
    words = (
        f"The arrays are those of {scalar}: entry (i, k) of pose j of array a at [j s[3 a] + i s[3 a + 1] + k "
        "s[3 a + 2]], s = strides, in numbers; k is 0 for vectors and nonzeros. Strides may be negative, and 0 for an "
        "input that all poses share."
    )
    wrapped: Sequence[str] = textwrap.wrap(words, _WIDTH)
    parameters = (
        "@param[in] count number of poses",
        "@param[in] strides three for each array, in the order of the arrays",
    )
    return (f"@brief {scalar} for arrays of any strides.", "", *wrapped, *parameters)
