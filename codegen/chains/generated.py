"""The equations of a chain as its own generated routines, compiled."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from codegen.chains.equations import Closure, Terms
from codegen.chains.partition import Partition
from codegen.chains.programs import part as quantities_of
from codegen.chains.rate_code import RateCode
from codegen.chains.switches import Switch
from codegen.ir.program import Program
from codegen.mechanics.chain.model import chain_program, kept_rows
from codegen.simulate.callable import Evaluate, callables
from codegen.spec.chain import Chain

Array = NDArray[np.float64]

Functions = Callable[[Sequence[Program]], list[Evaluate]]
"""Makes functions of programs."""

_NOT_MOVED = np.eye(3, 4).ravel(order="F")
"""Pose of a base that could move."""

_TERMS = ("gamma_R", "M", "f_C", "f_G")


class Generated:
    """`codegen.chains.equations.Equations` of a chain with a fixed base, and what is recorded of a run.

    Args:
        chain: the chain.
        has_loads: whether inertia, forces and wrenches are wanted too.
        functions: makes functions of programs; compiles them if left out.

    Raises:
        SpecificationError: there is no C compiler.
    """

    def __init__(self, chain: Chain, has_loads: bool = True, functions: Functions = callables) -> None:
        self._chain = chain
        self._rows = np.array(kept_rows(chain), dtype=np.intp)
        self._height = 6 * len(chain.cuts)
        wanted = _wanted(chain, has_loads)
        names = [*dict.fromkeys(name for names in wanted.values() for name in names)]
        self._program = chain_program(chain, names)
        compiled = functions([quantities_of(self._program, names) for names in wanted.values()])
        self._codes: dict[tuple[int, ...], RateCode] = {}
        self._routines: dict[str, Evaluate] = dict(zip(wanted, compiled, strict=True))

    @property
    def binding(self) -> tuple[bool, ...]:
        """Of each row of the cuts, whether a coordinate moves it."""
        return tuple(row in self._rows for row in range(self._height))

    def closure(self, q: Array) -> Closure:
        """Evaluate the cuts."""
        n = len(q)
        if not self._height:
            return Closure(np.zeros((0, 3)), np.zeros((0, 3, 3)), np.zeros((0, 3, n)), np.zeros((0, 3, n)))
        found = self._routines["closure"](q=q)
        poses = found["closure"].reshape(-1, 4, 3)
        J = self._all_rows(found["J"]).reshape(-1, 2, 3, n)
        return Closure(poses[:, 3], poses[:, :3].transpose(0, 2, 1), J[:, 0], J[:, 1])

    def constraint(self, q: Array) -> tuple[Array, Array] | None:
        """Evaluate ``(p; 2e)`` and its derivative; None where a cut is turned by more than 120 degrees."""
        if not self._height:
            return np.zeros(0), np.zeros((0, len(q)))
        found = self._routines["constraint"](q=q)
        traces = found["closure"].reshape(-1, 12)[:, [0, 4, 8]].sum(axis=1)
        if (traces < 0).any():
            return None
        return self._all_rows(found["phi"]), self._all_rows(found["phi_q"])

    def jacobian(self, q: Array) -> Array:
        """Evaluate J [6 nr, n]."""
        return self._all_rows(self._routines["closure"](q=q)["J"]) if self._height else np.zeros((0, len(q)))

    def gamma(self, q: Array, qd: Array) -> Array:
        """Evaluate gamma_R [6 nr]."""
        return self._all_rows(self._routines["gamma"](q=q, qd=qd)["gamma_R"]) if self._height else np.zeros(0)

    def terms(self, q: Array, qd: Array) -> Terms:
        """Evaluate the terms of the equations of motion."""
        found = self._routines["terms"](q=q, qd=qd)
        gamma = self._all_rows(found["gamma_R"]) if self._height else np.zeros(0)
        return Terms(gamma, found["M"].reshape(len(q), -1), found["f_C"], found["f_G"])

    def code(self, part: Partition, is_driven: NDArray[np.bool_], switches: Sequence[Switch]) -> RateCode:
        """Compile the motion by the independent coordinates [nv], once for each choice of them."""
        key = (*part.v.tolist(), *is_driven.tolist())
        if key not in self._codes:
            self._codes[key] = RateCode(self._chain.name, self._program, part, is_driven, switches)
        return self._codes[key]

    def applied(self, q: Array, qd: Array, on: Array) -> tuple[Array, Array]:
        """Evaluate what acts on coordinates [n] and at effectors [6 ne]."""
        found = self._routines["applied"](q=q, qd=qd, on=on)
        return found["tau_S"], found.get("f_S", np.zeros(0))

    def effectors(self, q: Array) -> Array:
        """Evaluate D_E [6 ne, n], axes of the effectors."""
        return self._routines["effectors"](q=q)["D_E"].reshape(-1, len(q))

    def frames(self, q: Array) -> Array:
        """Evaluate the frames of links, C, R and E [., 3, 4] in the axes of the base: rotation, origin."""
        found = self._routines["frames"](q=q, T_0=_NOT_MOVED)["frames"]
        return np.asarray(found.reshape(-1, 4, 3).transpose(0, 2, 1))

    def wrenches(self, q: Array, qd: Array, qdd: Array, f_R: Array, f_E: Array) -> Array:
        """Evaluate what each joint exerts on its link [n, 6]: force, moment about the link's origin, link axes."""
        found = self._routines["wrenches"](q=q, qd=qd, qdd=qdd, f_R=f_R, f_E=f_E)
        return np.asarray(found["wrenches"].reshape(-1, 6))

    def _all_rows(self, values: Array) -> Array:
        """Rows of all cuts; those that no coordinate moves are 0."""
        found = np.zeros((self._height, *values.shape[1:]))
        found[self._rows] = values
        return found


_ROUTINES: dict[str, tuple[str, ...]] = {
    "closure": ("closure", "J"),
    "constraint": ("closure", "phi", "phi_q"),
    "gamma": ("gamma_R",),
    "terms": _TERMS,
    "applied": ("tau_S", "f_S"),
    "effectors": ("D_E",),
    "frames": ("frames",),
    "wrenches": ("wrenches",),
}

_OF_LOADS = ("terms", "applied", "wrenches")


def _wanted(chain: Chain, has_loads: bool) -> dict[str, tuple[str, ...]]:
    """Routine -> those of its quantities that the chain has, in a routine that has any."""
    known = (*replace(chain, quantities=()).wanted, "tau_S", *(["f_S"] if chain.effectors else []))
    names = [name for name in _ROUTINES if has_loads or name not in _OF_LOADS]
    found = {name: tuple(quantity for quantity in _ROUTINES[name] if quantity in known) for name in names}
    return {name: quantities for name, quantities in found.items() if quantities}
