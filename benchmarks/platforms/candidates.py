"""The candidates: each takes all poses and gives D and C [poses, 4] of sigma, beta, alpha, gamma."""

from __future__ import annotations

import ctypes
import os
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import casadi
import numpy as np
from numpy.typing import NDArray

import codegen
from benchmarks.peers.eigen import eigen_include
from codegen.emit.batch_files import vector_headers
from codegen.emit.c import entries
from codegen.emit.casadi import casadi_function
from codegen.emit.package import banner
from codegen.emit.scene_package import real_header
from codegen.platforms.generate import LANES, batch_header, batch_routines, batch_source
from codegen.platforms.programs import routine
from codegen.spec.platform import Platform

Array = NDArray[np.float64]
Evaluate = Callable[[Array, Array], tuple[Array, Array]]
"""Takes o [poses, 3] and R [poses, 3, 3]."""

HERE = Path(__file__).parent
FLAGS = ("-O3", "-march=native", "-ffp-contract=off", "-fno-math-errno", "-shared", "-fPIC")

_SCALAR = """
#include "jg_real.h"
{text}
void evaluate(long count, const double *o, const double *R, double *D, double *C)
{{
    for (long k = 0; k < count; ++k) {{
        {symbol}(o + 3 * k, R + 9 * k, D + 4 * k, C + 4 * k);
    }}
}}
"""

_CASADI = """
#include "indices.c"
void evaluate(long count, const double *o, const double *R, double *D, double *C)
{{
    static double w[{work}];
    for (long k = 0; k < count; ++k) {{
        const double *arg[{arg}] = {{o + 3 * k, R + 9 * k}};
        double *res[{res}] = {{D + 4 * k, C + 4 * k}};
        indices(arg, res, 0, w, 0);
    }}
}}
"""


def candidates(platform: Platform, folder: Path) -> dict[str, Evaluate]:
    """Build everything; Eigen only where its headers are."""
    found: dict[str, Evaluate] = {}
    for variant in ("robust", "balanced", "fast"):
        chosen = with_variant(platform, variant)
        found[f"ours, {variant}, one pose"] = _scalar(chosen, folder)
        found[f"ours, {variant}, batch"] = _batch(chosen, folder)
        found[f"ours, {variant}, batch, --fma"] = _batch(with_variant(platform, variant, True), folder)
    found["CasADi's C, robust program"] = _casadi(with_variant(platform, "robust"), folder)
    found |= _eigen(platform, folder)
    found["numpy, batch QR and SVD"] = _numpy_batch(platform)
    found["numpy, pose by pose"] = _numpy_single(platform)
    return found


def with_variant(platform: Platform, variant: str, fma: bool = False) -> Platform:
    """The platform evaluated in another way."""
    return replace(platform, wanted=replace(platform.wanted, variant=variant, attitude="matrix", fma=fma))


def _compiled(folder: Path, source: Path, compiler: str, flags: tuple[str, ...] = ()) -> ctypes.CDLL:
    binary = source.with_suffix(".so")
    command = [compiler, *FLAGS, *flags, f"-I{folder}", str(source), "-o", str(binary), "-lm"]
    subprocess.run(command, check=True, capture_output=True)
    return ctypes.CDLL(str(binary))


def _looped(function: Any, leading: tuple[Array, ...] = ()) -> Evaluate:
    """Poses one after the other, matrices by columns."""
    function.restype = None

    def evaluate(o: Array, R: Array) -> tuple[Array, Array]:
        columns = np.ascontiguousarray(R.transpose(0, 2, 1))
        D, C = np.empty((len(o), 4)), np.empty((len(o), 4))
        arrays = (*leading, o, columns, D, C)
        function(ctypes.c_long(len(o)), *(ctypes.c_void_p(array.ctypes.data) for array in arrays))
        return D, C

    return evaluate


def _scalar(platform: Platform, folder: Path) -> Evaluate:
    made = routine(platform, "all", ("D", "C"))
    source = folder / f"{platform.wanted.variant}.c"
    source.write_text(_SCALAR.format(text=entries(made)[0].text, symbol=made.symbol))
    (folder / "jg_real.h").write_text(real_header(codegen.__version__, "double", True))
    return _looped(_compiled(folder, source, "gcc").evaluate)


def _batch(platform: Platform, folder: Path) -> Evaluate:
    made, lanes = routine(platform, "all", ("D", "C")), LANES["double"]
    groups = batch_routines(made, lanes)[:1]
    own = folder / f"batch_{platform.wanted.variant}{'_fma' * platform.wanted.fma}"
    own.mkdir()
    source = own / "batch.c"
    source.write_text(batch_source(platform.name, groups, lanes, "", "benchmark"))
    headers = vector_headers(lanes, banner(codegen.__version__), choices=True)
    headers |= {f"{platform.name}_batch{lanes}": batch_header(platform.name, groups, lanes, "")}
    headers |= {"jg_real": real_header(codegen.__version__, "double", True, True)}
    for name, text in headers.items():
        (own / f"{name}.h").write_text(text)
    function = _compiled(own, source, "gcc")[f"{made.symbol}_batch{lanes}_soa"]
    function.restype = None

    def evaluate(o: Array, R: Array) -> tuple[Array, Array]:
        count = len(o)
        by_entry = np.ascontiguousarray(o.T), np.ascontiguousarray(R.transpose(2, 1, 0)).reshape(9, count)
        D, C = np.empty((4, count)), np.empty((4, count))
        pointers = (ctypes.c_void_p(array.ctypes.data) for array in (*by_entry, D, C))
        function(ctypes.c_long(count), ctypes.c_long(count), *pointers)
        return D.T, C.T

    return evaluate


def _casadi(platform: Platform, folder: Path) -> Evaluate:
    made = casadi_function("indices", routine(platform, "all", ("D", "C")).straight)
    before = Path.cwd()
    os.chdir(folder)
    try:
        made.generate("indices.c")
    finally:
        os.chdir(before)
    source = folder / "casadi_loop.c"
    sizes = {"arg": made.sz_arg(), "res": made.sz_res(), "work": made.sz_w() + 1}
    source.write_text(_CASADI.format(**sizes))
    return _looped(_compiled(folder, source, "gcc").evaluate)


def _eigen(platform: Platform, folder: Path) -> dict[str, Evaluate]:
    shipped = Path(casadi.__file__).parent / "include" / "eigen3"
    try:
        include = shipped if (shipped / "Eigen/Core").exists() else eigen_include()
    except ModuleNotFoundError:
        return {}
    source = folder / "eigen.cpp"
    source.write_text((HERE / "eigen_indices.cpp").read_text())
    loaded = _compiled(folder, source, "g++", (f"-I{include}", "-DNDEBUG"))
    points = tuple(np.array(p, dtype=float) for p in (platform.base, platform.joints))
    return {
        "Eigen, QR and SVD": _looped(loaded.eigen_qr_svd, points),
        "Eigen, Gram matrices, direct": _looped(loaded.eigen_gram, points),
    }


def _numpy_batch(platform: Platform) -> Evaluate:
    base, joints = (np.array(p, dtype=float) for p in (platform.base, platform.joints))

    def evaluate(o: Array, R: Array) -> tuple[Array, Array]:
        p = np.einsum("nij,lj->nli", R, joints)
        legs = p + (o[:, None] - base)
        e = legs / np.linalg.norm(legs, axis=2, keepdims=True)
        first, second = e, np.cross(p, e)
        pairs = [_values(np.concatenate(pair, axis=2)) for pair in ((second, first), (first, second))]
        (gamma, sigma), (beta, alpha) = pairs
        values = np.stack([sigma, beta, alpha, gamma], axis=1)
        return values.prod(axis=2), values[:, :, 0] / values[:, :, 2]

    return evaluate


def _values(matrices: Array) -> tuple[Any, Any]:
    R: Any = np.linalg.qr(matrices, mode="r")
    return np.linalg.svd(R[..., :3, :3], compute_uv=False), np.linalg.svd(R[..., 3:, 3:], compute_uv=False)


def _numpy_single(platform: Platform) -> Evaluate:
    batch = _numpy_batch(platform)

    def evaluate(o: Array, R: Array) -> tuple[Array, Array]:
        found = [batch(o[k : k + 1], R[k : k + 1]) for k in range(len(o))]
        return np.concatenate([D for D, _ in found]), np.concatenate([C for _, C in found])

    return evaluate
