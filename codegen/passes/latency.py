"""How long results take on a processor that runs a routine for one joint; lanes have theirs in `alternate`."""

from __future__ import annotations

from codegen.ir.ops import Op

LATENCY: dict[Op, int] = {
    Op.ADD: 4,
    Op.SUBTRACT: 4,
    Op.MULTIPLY: 4,
    Op.FMA: 4,
    Op.DIVIDE: 13,
    Op.SQRT: 18,
    Op.SIN: 60,
    Op.COS: 60,
    Op.SINCOS: 80,
    Op.ATAN2: 100,
    Op.ABS: 1,
    Op.SELECT: 5,
}
"""Cycles until a result is ready, about, on processors of today; what is missing is there at once."""
