"""The motion of a chain by its independent coordinates, compiled: what `codegen.chains.moving` does, where it is easy.

It takes the same steps on the same branch and refuses whatever is not beyond doubt: cuts that are not closed in a few
iterations that contract well, a Jacobian near a singular one or of the other orientation, coordinates without inertia.
"""

from __future__ import annotations

import ctypes
import textwrap
from collections.abc import Callable, Sequence
from ctypes import POINTER, byref, c_double, c_int, c_void_p
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

import codegen
from codegen.chains import dop853, newton
from codegen.chains.partition import Partition
from codegen.chains.rate_programs import motion_program, pose_program
from codegen.chains.switches import Switch
from codegen.emit.c import definition
from codegen.emit.environment import render
from codegen.emit.package import banner
from codegen.ir.program import Program
from codegen.simulate.compiled import call, declared
from codegen.simulate.library import library

Array = NDArray[np.float64]

FURTHEST = 0.25
"""rad, or characteristic lengths: an independent coordinate moves by about as much in a step, at most."""

_SOUND = 1e-6
"""Part of the largest pivot below which another is in doubt."""

_EXACT = 1e-13
"""rad, or characteristic lengths: the Jacobian before a last step that is smaller is that of the pose."""

_LEAST_INERTIA = 1e-12
"""Part of the largest pivot of the inertia matrix with ones on its diagonal."""

_DRIVE = ctypes.CFUNCTYPE(None, c_double, POINTER(c_double))


class RateCode:
    """Compiled motion; its state is the pose that it is at.

    Args:
        name: of the chain.
        program: of the chain, with the `codegen.chains.rate_programs.QUANTITIES` that it has.
        part: its coordinates and rows.
        is_driven: [nv] whether an independent coordinate is driven.
        switches: of its forces.

    Attributes:
        q: [n] coordinates where the motion is.
        qd: [n] rates there.
        qdd: [n] accelerations there.
        library: with the functions.
        size: of what is integrated, ``(q_f, qd_f, work)`` with f the coordinates that are not driven.

    Raises:
        SpecificationError: there is no C compiler.
    """

    def __init__(
        self, name: str, program: Program, part: Partition, is_driven: NDArray[np.bool_], switches: Sequence[Switch]
    ) -> None:
        sizes = _sizes(part, is_driven, switches)
        self.library = library(_source(name, program, part, is_driven, sizes), {"jg_dop853.h": dop853.header()})
        self.library.jg_chain_rate.argtypes = [c_void_p, c_double, c_void_p, c_void_p]
        self._state: Any = _state(sizes)()
        for k, switch in enumerate(switches):
            self._state.sense[k], self._state.asked[k] = switch.sign, switch.coordinate
            self._state.bound[k], self._state.of_rate[k] = switch.bound or 0.0, switch.bound is None
        self.q, self.qd, self.qdd = (np.ctypeslib.as_array(getattr(self._state, word)) for word in ("q", "qd", "qdd"))
        self.size, self._driven = sizes["Y"], 3 * sizes["D"]
        self._rows, self._independent = len(part.w), len(part.v)

    @property
    def motion(self) -> Any:
        """``struct jg_chain``, as functions take it."""
        return byref(self._state)

    @property
    def iterations(self) -> int:
        """Steps of Newton's method so far."""
        return int(self._state.iterations)

    def drive(self, values: Callable[[float], Array], longest: float) -> None:
        """Say how the driven coordinates move.

        Args:
            values: gives [3 nd] values, rates and accelerations.
            longest: s, a step that overlooks nothing of these motions.
        """

        def driven(t: float, found: Any) -> None:
            np.ctypeslib.as_array(found, (self._driven,))[:] = values(t)

        self._state.drive, self._state.longest = _DRIVE(driven), longest

    @property
    def slope(self) -> Array:
        """[nw, nv] d q_w / d q_v where the motion is, without dimension."""
        found = np.array(self._state.slope[: self._rows * self._independent])
        return found.reshape(self._independent, self._rows).T

    def enter(self, q: Array, dependent: Array, steepest: float) -> bool:
        """Take a closed pose; False if it is not sound.

        Args:
            q: [n].
            dependent: [m, nw] Jacobian of the dependent coordinates there, without dimension.
            steepest: slope of a free coordinate behind which the integration stops.
        """
        self._state.steepest = steepest
        self.q[:] = q
        order = scipy.linalg.qr(dependent.T, mode="r", pivoting=True)[-1] if self._rows else []
        self._state.rows[: self._rows] = sorted(map(int, order[: self._rows]))
        return bool(self.library.jg_chain_enter(self.motion))

    def switch(self, is_on: Sequence[bool], active: Sequence[bool]) -> None:
        """Say which switches are on, and which forces act."""
        self._state.is_on[: len(is_on)] = [int(on) for on in is_on]
        self._state.on[: len(active)] = [float(one) for one in active]

    def rate(self, t: float, y: Array) -> Array | None:
        """Rates of what is integrated; None where they are not beyond doubt."""
        found, given = np.empty(self.size), np.ascontiguousarray(y)
        is_found = self.library.jg_chain_rate(self.motion, t, given.ctypes.data, found.ctypes.data)
        return found if is_found else None


def _sizes(part: Partition, is_driven: NDArray[np.bool_], switches: Sequence[Switch]) -> dict[str, int]:
    n, v, d = len(part.units), len(part.v), int(is_driven.sum())
    conditions = len({switch.condition for switch in switches})
    sizes = {"N": n, "V": v, "W": len(part.w), "F": v - d, "D": d, "Y": 2 * (v - d) + 1, "R": len(part.rows)}
    return {**sizes, "S": conditions, "K": len(switches)}


def _state(sizes: dict[str, int]) -> type[ctypes.Structure]:
    """``struct jg_chain``."""
    n, w, k = sizes["N"], sizes["W"], sizes["K"]

    class State(ctypes.Structure):
        _fields_ = [
            *((word, c_double * n) for word in ("q", "qd", "qdd")),
            ("slope", c_double * (w * sizes["V"] + 1)),
            ("orientation", c_double),
            ("lu", c_double * (w * w + 1)),
            ("sign", c_double),
            ("on", c_double * (sizes["S"] + 1)),
            *((word, c_double * (k + 1)) for word in ("sense", "bound")),
            *((word, c_double) for word in ("longest", "steepest")),
            ("drive", _DRIVE),
            *((word, c_int * (w + 1)) for word in ("swaps", "rows")),
            *((word, c_int * (k + 1)) for word in ("asked", "of_rate", "is_on")),
            ("iterations", c_int),
        ]

    return State


def _source(name: str, program: Program, part: Partition, is_driven: NDArray[np.bool_], sizes: dict[str, int]) -> str:
    programs = [motion_program(program, part)]
    programs += [pose_program(program, part)] if len(part.rows) else []
    tables = {"v": part.v, "w": part.w, "f": np.flatnonzero(~is_driven), "d": np.flatnonzero(is_driven)}
    calls = [call(one) for one in programs]
    return render(
        "simulate/chain_rate.c.j2",
        banner=banner(codegen.__version__),
        name=name,
        functions=[definition(*declared(one), one, "static void")[0] for one in programs],
        motion=calls[0],
        pose=calls[1] if len(calls) > 1 else "(void)q;",
        sizes={**sizes, "ITERATIONS": newton.ITERATIONS},
        limits={
            "SOUND": _SOUND,
            "EXACT": _EXACT,
            "LEAST_INERTIA": _LEAST_INERTIA,
            "FURTHEST": FURTHEST,
            "REACH": part.reach,
            "LARGEST_STEP": newton.LARGEST_STEP,
            "STEP": newton.STEP,
            "RESIDUAL": newton.RESIDUAL,
            "PREDICTED": newton.PREDICTED,
            "CORRECTED": newton.CORRECTED,
            "CONTRACTION": newton.CONTRACTION,
            "TINY": newton.TINY,
        },
        tables={word: _lines([*numbers.tolist(), 0]) for word, numbers in tables.items()},
        units=_lines(part.units.tolist()),
    )


def _lines(values: Sequence[float]) -> list[str]:
    return textwrap.wrap(", ".join(map(repr, values)), 108)
