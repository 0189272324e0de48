"""The motion of a chain by its independent coordinates, compiled: what `codegen.chains.moving` does, where it is easy.

It takes the same steps on the same branch and refuses whatever is not beyond doubt: cuts that are not closed in a few
iterations that contract well, a Jacobian near a singular one or of the other orientation, coordinates without inertia.
"""

from __future__ import annotations

import ctypes
import textwrap
from collections.abc import Sequence
from ctypes import c_double, c_int, c_void_p

import numpy as np
import scipy.linalg
from numpy.typing import NDArray
from scipy.integrate import DOP853

import codegen
from codegen.chains import path, position
from codegen.chains.partition import Partition
from codegen.chains.rate_programs import motion_program, pose_program
from codegen.emit.c import definition
from codegen.emit.environment import render
from codegen.emit.package import banner
from codegen.ir.program import Program
from codegen.simulate.compiled import declared
from codegen.simulate.library import library

Array = NDArray[np.float64]

_SOUND = 1e-6
"""Part of the largest pivot below which another is in doubt."""

_EXACT = 1e-13
"""rad, or characteristic lengths: the Jacobian before a last step that is smaller is that of the pose."""

_LEAST_INERTIA = 1e-12

_WEIGHTS = np.ascontiguousarray(DOP853.A)


class RateCode:
    """Compiled motion; its state is the pose that it is at.

    Args:
        name: of the chain.
        program: of the chain, with the `codegen.chains.rate_programs.QUANTITIES` that it has.
        part: its coordinates and rows.
        driven: [nv] whether an independent coordinate is driven.
        switches: number of forces that switch.

    Attributes:
        q: [n] coordinates where the motion is; what is entered is written here.
        qd: [n] rates there.
        qdd: [n] accelerations there.
        on: [ns] 1 for forces that act, else 0; to be written.

    Raises:
        SpecificationError: there is no C compiler.
    """

    def __init__(self, name: str, program: Program, part: Partition, driven: Sequence[bool], switches: int) -> None:
        self._part = part
        sizes = _sizes(part, driven, switches)
        self._library = library(_source(name, program, part, driven, sizes))
        state = _state(sizes)()
        self.q, self.qd, self.qdd = (np.ctypeslib.as_array(getattr(state, word)) for word in ("q", "qd", "qdd"))
        self.on = np.ctypeslib.as_array(state.on)[:switches]
        self._rows = np.ctypeslib.as_array(state.rows)[: len(part.w)]
        self._rate = np.zeros(2 * sizes["F"] + 1)
        self._y, self._drive = np.zeros(2 * sizes["F"] + 1), np.zeros(3 * sizes["D"] + 1)
        self._state = state
        self._arguments = [c_void_p(a) for a in (ctypes.addressof(state), *map(_at, (self._y, self._drive, self._rate)))]
        self._library.jg_chain_step.argtypes = [*[ctypes.c_void_p] * 4, c_double, *[ctypes.c_void_p] * 3]

    @property
    def iterations(self) -> int:
        """Steps of Newton's method so far."""
        return int(self._state.iterations)

    def enter(self, q: Array, dependent: Array) -> bool:
        """Take a closed pose; False if it is not sound.

        Args:
            q: [n].
            dependent: [m, nw] Jacobian of the dependent coordinates there, without dimension.
        """
        self.q[:] = q
        order = scipy.linalg.qr(dependent.T, mode="r", pivoting=True)[-1]
        self._rows[:] = np.sort(order[: len(self._rows)])
        return bool(self._library.jg_chain_enter(self._arguments[0]))

    def rate(self, y: Array, drive: Array) -> Array | None:
        """Rates of ``(q_f, qd_f, work)``; None where they are not beyond doubt.

        Args:
            y: [2 nf + 1].
            drive: [3 nd] values, rates and accelerations of the driven coordinates.
        """
        self._y[:] = y
        self._drive[: len(drive)] = drive
        return self._rate.copy() if self._library.jg_chain_rate(*self._arguments) else None

    def step(self, y: Array, h: float, drives: Array, rates: Array) -> Array | None:
        """Take one step of DOP853; None where a stage is not beyond doubt.

        Args:
            y: [2 nf + 1] at its start.
            h: s.
            drives: [stages, 3 nd] of the driven coordinates, at all stages but the first and at the end of the step.
            rates: [stages + 1, 2 nf + 1] rates of the stages and at the end; the first is given, the others are written.

        Returns:
            What is integrated, at the end.
        """
        end = np.empty_like(y)
        given = (self._arguments[0], _at(_WEIGHTS), _at(DOP853.B), _at(y), h, _at(drives), _at(rates), _at(end))
        return end if self._library.jg_chain_step(*given) else None


def _at(array: Array) -> int:
    return int(array.ctypes.data)


def _sizes(part: Partition, driven: Sequence[bool], switches: int) -> dict[str, int]:
    n, v, d = len(part.units), len(part.v), sum(driven)
    return {"N": n, "V": v, "W": len(part.w), "F": v - d, "D": d, "R": len(part.rows), "S": switches}


def _state(sizes: dict[str, int]) -> type[ctypes.Structure]:
    """``struct jg_chain``."""
    n, w = sizes["N"], sizes["W"]

    class State(ctypes.Structure):
        _fields_ = [
            *((word, c_double * n) for word in ("q", "qd", "qdd")),
            ("slope", c_double * (w * sizes["V"] + 1)),
            ("orientation", c_double),
            ("lu", c_double * (w * w + 1)),
            ("sign", c_double),
            ("on", c_double * (sizes["S"] + 1)),
            *((word, c_int * (w + 1)) for word in ("swaps", "rows")),
            ("iterations", c_int),
        ]

    return State


def _source(name: str, program: Program, part: Partition, driven: Sequence[bool], sizes: dict[str, int]) -> str:
    programs = [motion_program(program, part)]
    programs += [pose_program(program, part)] if len(part.rows) else []
    kinds = np.array(driven, dtype=bool)
    tables = {"v": part.v, "w": part.w, "f": np.flatnonzero(~kinds), "d": np.flatnonzero(kinds)}
    calls = [_call(one) for one in programs]
    return render(
        "simulate/chain_rate.c.j2",
        banner=banner(codegen.__version__),
        name=name,
        functions=[definition(*declared(one), one, "static void")[0] for one in programs],
        motion=calls[0],
        pose=calls[1] if len(calls) > 1 else "(void)q;",
        sizes={**sizes, "Y": 2 * sizes["F"] + 1, "STAGES": DOP853.n_stages, "ITERATIONS": path.ITERATIONS},
        limits={
            "SOUND": _SOUND,
            "EXACT": _EXACT,
            "LEAST_INERTIA": _LEAST_INERTIA,
            "REACH": part.reach,
            "LARGEST_STEP": position.LARGEST_STEP,
            "STEP": position.STEP,
            "RESIDUAL": position.RESIDUAL,
            "PREDICTED": path.PREDICTED,
            "CORRECTED": path.CORRECTED,
            "CONTRACTION": path.CONTRACTION,
            "TINY": path.TINY,
        },
        tables={word: _lines([*numbers.tolist(), 0]) for word, numbers in tables.items()},
        units=_lines(part.units.tolist()),
    )


def _call(program: Program) -> str:
    symbol, parameters = declared(program)
    return f"{symbol}({', '.join(parameter.name for parameter in parameters)});"


def _lines(values: Sequence[float]) -> list[str]:
    return textwrap.wrap(", ".join(map(repr, values)), 108)
