"""Random open chains of revolute and prismatic joints: the generated routines beside Pinocchio's."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from codegen.mechanics.chain.model import chain_program
from codegen.passes import simplify
from codegen.simulate.callable import callables
from codegen.spec.chain import BASE, Chain, Link, Row
from tests.mechanics.chain.trees import tree

Array = NDArray[np.float64]

CHAINS = 20
STATES = 10
TOLERANCE = 1e-11
"""Of the largest value of a quantity in a state."""

_QUANTITIES = ("M", "f_C", "f_G", "D_E")


@dataclass(frozen=True, slots=True)
class Agreement:
    """Largest differences, relative to the largest value of the quantity in the state.

    Attributes:
        M: inertia matrix.
        bias: ``f_C - f_G``.
        D_E: Jacobians of the end effectors.
    """

    M: float
    bias: float
    D_E: float


def agreement(count: int = CHAINS, states: int = STATES) -> Agreement:
    """Compare random chains of 3 to 10 links, two end effectors each, in random states.

    Args:
        count: of chains.
        states: of each.

    Raises:
        ArithmeticError: they do not agree to `TOLERANCE`.
    """
    chains = [tree(100 + k, 3 + k % 8, 0, 2)[0] for k in range(count)]
    evaluations = callables([simplify(chain_program(chain, _quantities(chain))) for chain in chains])
    found = np.zeros(3)
    for k, (chain, evaluate) in enumerate(zip(chains, evaluations, strict=True)):
        other, random = Pinocchio(chain), np.random.default_rng(k)
        for _ in range(states):
            q, qd = random.normal(size=(2, len(chain.links)))
            ours = evaluate(q=q, qd=qd)
            pairs = zip((ours["M"], ours["f_C"] - ours["f_G"], ours["D_E"]), other.evaluate(q, qd), strict=True)
            found = np.maximum(found, [_difference(*pair) for pair in pairs])
    if not found.max() < TOLERANCE:
        raise ArithmeticError(f"open chains differ from Pinocchio by {found.max():.1e}")
    return Agreement(*map(float, found))


def _quantities(chain: Chain) -> tuple[str, ...]:
    assert set(_QUANTITIES) <= set(chain.wanted)
    return _QUANTITIES


def _difference(ours: Array, theirs: Array) -> float:
    scale = np.abs(theirs).max()
    return float(np.abs(ours - theirs).max() / scale) if scale else float(np.abs(ours).max())


def _depth_first(chain: Chain, carrier: str) -> list[int]:
    """Numbers of the links that hang on a carrier, each followed by those that hang on it."""
    hung = [(k, link.name) for k, link in enumerate(chain.links) if link.parent == carrier]
    return [number for k, name in hung for number in (k, *_depth_first(chain, name))]


class Pinocchio:
    """An open chain as a model of Pinocchio, made from the rows of its file.

    Joints are added depth first: the composite bodies of its inertia matrix take a subtree for a run of joints.
    """

    def __init__(self, chain: Chain) -> None:
        import pinocchio as pin

        self._pin, self._model = pin, pin.Model()
        self._model.gravity.linear = np.array(chain.gravity, float)
        self._order = _depth_first(chain, BASE)
        numbers = {BASE: 0}
        for link in (chain.links[k] for k in self._order):
            numbers[link.name] = self._hang(link, numbers[link.parent])
        self._ends = [
            self._model.addFrame(
                pin.Frame(e.name, numbers[e.frame.link], 0, self._placed(e.frame.row, True, True), pin.OP_FRAME)
            )
            for e in chain.effectors
        ]
        self._data = self._model.createData()

    def evaluate(self, q: Array, qd: Array) -> tuple[Array, Array, Array]:
        """Inertia matrix, bias forces with gravity, and Jacobians of the end effectors in their own axes."""
        pin, model, data = self._pin, self._model, self._data
        q, qd, back = q[self._order], qd[self._order], np.argsort(self._order)
        upper = np.triu(pin.crba(model, data, q))
        M = upper + np.triu(upper, 1).T
        bias = np.array(pin.nonLinearEffects(model, data, q, qd))
        D_E = np.concatenate([pin.computeFrameJacobian(model, data, q, end, pin.LOCAL) for end in self._ends])
        return M[np.ix_(back, back)], bias[back], D_E[:, back]

    def _hang(self, link: Link, parent: int) -> int:
        pin, is_revolute = self._pin, link.type == "revolute"
        placement = self._placed(link.row, not is_revolute, is_revolute)
        joint = pin.JointModelRZ() if is_revolute else pin.JointModelPZ()
        number = int(self._model.addJoint(parent, joint, placement, link.name))
        body = pin.Inertia(float(link.mass), np.array(link.centre, float), np.array(link.inertia, float))
        self._model.appendBodyToJoint(number, body, pin.SE3.Identity())
        return number

    def _placed(self, row: Row, has_theta: bool, has_d: bool) -> Any:
        first = self._screw("z", row.psi, row.c) * self._screw("x", row.alpha, row.a)
        return first * self._screw("z", row.theta if has_theta else 0, row.d if has_d else 0)

    def _screw(self, axis: str, angle: Any, shift: Any) -> Any:
        along = np.array([axis == "x", False, axis == "z"], float)
        return self._pin.SE3(self._pin.utils.rotate(axis, float(angle)), float(shift) * along)
