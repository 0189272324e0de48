"""The fused multiply-add ``a b + c`` of IEEE 754, rounded once: what C's ``fma`` and ``fmaf`` give, for Python.

Double precision goes through exact integers; single precision through double, where the product is exact and the sum
is rounded to odd, so that the second rounding is the only one that counts (Boldo and Melquiond 2008).
"""

from __future__ import annotations

import math
from typing import Any


def fused_multiply_add(a: float, b: float, c: float) -> float:
    """Give ``a b + c`` rounded once to the nearest double, ties to even; infinities and NaN as in IEEE 754."""
    if not (math.isfinite(a) and math.isfinite(b)) or a == 0.0 or b == 0.0:
        return a * b + c
    if not math.isfinite(c):
        return c
    (n_a, d_a), (n_b, d_b), (n_c, d_c) = (value.as_integer_ratio() for value in (a, b, c))
    numerator, denominator = n_a * n_b * d_c + n_c * d_a * d_b, d_a * d_b * d_c
    if numerator == 0:
        return 0.0
    try:
        return numerator / denominator
    except OverflowError:
        return math.inf if numerator > 0 else -math.inf


def fused_multiply_add_arrays(a: Any, b: Any, c: Any) -> Any:
    """The same of arrays or numpy scalars, elementwise; in single precision if all three are single."""
    import numpy

    if numpy.result_type(a, b, c) == numpy.float32:
        return _single(numpy.float64(a), numpy.float64(b), numpy.float64(c))
    fused = numpy.frompyfunc(lambda x, y, z: fused_multiply_add(float(x), float(y), float(z)), 3, 1)
    return numpy.float64(fused(a, b, c))


def _single(a: Any, b: Any, c: Any) -> Any:
    """``a b + c`` of doubles that hold singles, rounded to single."""
    import numpy

    with numpy.errstate(invalid="ignore", over="ignore"):
        product = a * b
        total = product + c
        part = total - product
        error = (product - (total - part)) + (c - part)
        last_bit = numpy.atleast_1d(total).view(numpy.int64).reshape(numpy.shape(total)) & 1
        moves = numpy.isfinite(total) & (error != 0.0) & (last_bit == 0)
        neighbour = numpy.nextafter(total, numpy.where(error > 0.0, numpy.inf, -numpy.inf))
        return numpy.float32(numpy.where(moves, neighbour, total))
