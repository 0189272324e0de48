"""A chain in a random state that is possible, and its program evaluated there."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

from codegen.ir.evaluate import evaluate
from codegen.ir.program import Program
from codegen.mechanics.chain.model import chain_program
from codegen.passes import simplify
from codegen.spec.chain import Chain
from tests.mechanics.chain.series import Account, Series


@dataclass
class State:
    """Arguments of the routines, and the account of the same state."""

    inputs: dict[str, np.ndarray]
    account: Account


def state(chain: Chain, q: np.ndarray, seed: int = 0) -> State:
    """Random velocities, accelerations and wrenches; the velocities are those that the cuts allow."""
    random = np.random.default_rng(seed)
    size = len(q)
    qd = _possible(Account(chain, q).J(), random.normal(size=size)) if chain.cuts else random.normal(size=size)
    qdd = random.normal(size=size)
    base, inputs = _base(random) if chain.base == "moving" else (None, {})
    wrenches = {"f_R": random.normal(size=6 * len(chain.cuts)), "f_E": random.normal(size=6 * len(chain.effectors))}
    return State({"q": q, "qd": qd, "qdd": qdd, **wrenches, **inputs}, Account(chain, q, qd, qdd, base))


def _possible(J: np.ndarray, qd: np.ndarray) -> np.ndarray:
    _, sizes, directions = np.linalg.svd(J)
    free = directions[int((sizes > 1e-9 * max(1.0, sizes[0])).sum()) :].T
    return free @ free.T @ qd


def _base(random: np.random.Generator) -> tuple[Series, dict[str, np.ndarray]]:
    """A base in motion: its series, and its pose, velocity and acceleration in its own axes."""
    R, _ = np.linalg.qr(random.normal(size=(3, 3)))
    R *= np.linalg.det(R)
    p, v, w, a, e = random.normal(size=(5, 3))
    series = np.zeros((3, 4, 4), complex)
    series[0, 3, 3] = 1
    series[0, :3, :3], series[0, :3, 3] = R, p
    series[1, :3, :3], series[1, :3, 3] = R @ _tilde(w), R @ v
    series[2, :3, :3], series[2, :3, 3] = R @ (_tilde(e) + _tilde(w) @ _tilde(w)) / 2, R @ a / 2
    return series, {
        "T_0": np.concatenate([R.T.ravel(), p]),
        "v_0": np.concatenate([v, w]),
        "vd_0": np.concatenate([a, e]),
    }


def _tilde(x: np.ndarray) -> np.ndarray:
    return np.array([[0, -x[2], x[1]], [x[2], 0, -x[0]], [-x[1], x[0], 0]])


def values(program: Program, inputs: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The outputs of a program as dense arrays."""
    found = {}
    stored = evaluate(program, inputs)
    for output in program.outputs:
        dense = np.zeros((output.sparsity.nrow, output.sparsity.ncol))
        for place, value in zip(output.sparsity.entries(), stored[output.name], strict=True):
            dense[place] = value
        found[output.name] = dense[:, 0] if dense.shape[1] == 1 else dense
    return found


def evaluated(chain: Chain, names: tuple[str, ...], inputs: dict[str, np.ndarray], progressive: bool = True) -> dict:
    """Quantities of a chain as dense arrays; they are derived once."""
    return values(_derived(chain, names, progressive), inputs)


@cache
def _derived(chain: Chain, names: tuple[str, ...], progressive: bool) -> Program:
    return simplify(chain_program(chain, names, progressive))
