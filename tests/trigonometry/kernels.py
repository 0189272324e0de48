"""Our own sine, cosine and arc tangent, compiled so that Python can call them: one number at a time, and in lanes."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from codegen.emit.batch_files import batch_headers
from codegen.emit.environment import render
from tests.harness.library import REAL, digest, run_compiler

Array = NDArray[Any]
LANES = 4

SOURCE = """
#define JG_BATCH 4
#include "jointgen/jg_batch.h"
void sincos_own(long n, const jg_real *x, jg_real *s, jg_real *c);
void sincos_lanes(long n, const jg_real *x, jg_real *s, jg_real *c);
void atan2_own(long n, const jg_real *y, const jg_real *x, jg_real *a);
void atan2_lanes(long n, const jg_real *y, const jg_real *x, jg_real *a);

void sincos_own(long n, const jg_real *x, jg_real *s, jg_real *c)
{
    for (long k = 0; k < n; ++k) {
        jg_sincos_own(x[k], s + k, c + k);
    }
}

void sincos_lanes(long n, const jg_real *x, jg_real *s, jg_real *c)
{
    for (long k = 0; k < n; k += JG_BATCH) {
        jg_vector sine;
        jg_vector cosine;
        jg_sincos_batch(*(const jg_lanes *)(x + k), &sine, &cosine);
        *(jg_lanes *)(s + k) = sine;
        *(jg_lanes *)(c + k) = cosine;
    }
}

void atan2_own(long n, const jg_real *y, const jg_real *x, jg_real *a)
{
    for (long k = 0; k < n; ++k) {
        a[k] = jg_atan2_own(y[k], x[k]);
    }
}

void atan2_lanes(long n, const jg_real *y, const jg_real *x, jg_real *a)
{
    for (long k = 0; k < n; k += JG_BATCH) {
        *(jg_lanes *)(a + k) = jg_atan2_batch(*(const jg_lanes *)(y + k), *(const jg_lanes *)(x + k));
    }
}
"""


class Kernels:
    """The functions in one number type, under one set of flags."""

    def __init__(self, folder: Path, real: str, flags: Sequence[str]) -> None:
        headers = dict(batch_headers((), LANES, "test", "test"))
        headers["c/include/jointgen/jg_real.h"] = render(
            "c/jg_real.h.j2", banner="test", real=real, batch=LANES, fma=False
        )
        for name, text in headers.items():
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        source = folder / "kernels.c"
        source.write_text(SOURCE)
        command = ["gcc", "-std=c99", "-fPIC", "-shared", *flags, f"-I{folder / 'c/include'}", str(source), "-lm"]
        self._object = ctypes.CDLL(str(run_compiler(command, folder / f"{digest(real, *flags)}.so")))
        self.kind, self.word, _ = REAL[real]

    def sincos(self, angles: Array, kind: str) -> tuple[Array, Array]:
        """Sines and cosines; kind: ``own`` or ``lanes``."""
        sines, cosines = np.empty_like(angles), np.empty_like(angles)
        self._call(f"sincos_{kind}", angles, sines, cosines)
        return sines, cosines

    def atan2(self, y: Array, x: Array, kind: str) -> Array:
        """Arc tangents; kind: ``own`` or ``lanes``."""
        angles = np.empty_like(y)
        self._call(f"atan2_{kind}", y, x, angles)
        return angles

    def _call(self, name: str, *arrays: Array) -> None:
        for array in arrays:
            assert array.dtype == self.kind and array.flags.c_contiguous and array.size % LANES == 0
        function = getattr(self._object, name)
        function.restype = None
        function(ctypes.c_long(arrays[0].size), *(ctypes.c_void_p(array.ctypes.data) for array in arrays))
