"""Random chains with several cuts, closed in a random pose; and the mechanisms of S2."""

from __future__ import annotations

import math
from fractions import Fraction
from pathlib import Path

import numpy as np
from tests.mechanics.chain.series import move

from codegen.spec.chain import BASE, Chain, Cut, Effector, Frame, Independent, Link, Row
from codegen.spec.chain_file import read_chain

EXAMPLES = Path(__file__).parents[3] / "examples" / "chains"
NONE = (Fraction(0),) * 3


def example(name: str) -> Chain:
    return read_chain((EXAMPLES / f"{name}.toml").read_text(), name)


def _row(random: np.random.Generator) -> Row:
    angle = lambda: random.choice([-2, -1, 0, 0, 1, 2]) * math.pi / 2 if random.random() < 0.6 else random.normal()  # noqa: E731
    length = lambda: 0.0 if random.random() < 0.4 else random.normal()  # noqa: E731
    values = angle(), length(), angle(), length(), angle(), length()
    return Row(*(Fraction(float(value)) for value in values))


def _mass(random: np.random.Generator):
    if random.random() < 0.3:
        return Fraction(0), NONE, (NONE,) * 3
    square = random.normal(size=(3, 3))
    inertia = square @ square.T if random.random() < 0.5 else np.diag(random.uniform(1, 2, 3))
    centre = random.normal(size=3) * (random.random(3) < 0.6)
    exact = tuple(tuple(Fraction(float(inertia[min(i, k), max(i, k)])) for k in range(3)) for i in range(3))
    return Fraction(float(random.uniform(0.5, 2))), tuple(Fraction(float(x)) for x in centre), exact


def _row_of(pose: np.ndarray) -> Row:
    """The six constants of a pose whose z is not that of the link."""
    alpha = math.acos(pose[2, 2])
    psi = math.atan2(pose[0, 2], -pose[1, 2])
    theta = math.atan2(pose[2, 0], pose[2, 1])
    directions = np.array([[0, 0, 1], [math.cos(psi), math.sin(psi), 0], pose[:3, 2]]).T
    c, a, d = np.linalg.solve(directions, pose[:3, 3])
    return Row(*(Fraction(float(value)) for value in (psi, c, alpha, a, theta, d)))


def tree(seed: int, size: int, cuts: int, effectors: int, base: str = "fixed", branching: bool = True) -> tuple[Chain, np.ndarray]:
    """A chain and a pose in which all its cuts are closed."""
    random = np.random.default_rng(seed)
    q = random.normal(size=size)
    links = []
    for k in range(size):
        earlier = random.integers(0, k) if branching and k and random.random() < 0.4 else k - 1
        parent = BASE if k == 0 or (branching and random.random() < 0.1) else f"link {earlier}"
        kind = "prismatic" if random.random() < 0.3 else "revolute"
        links.append(Link(f"link {k}", parent, kind, _row(random), *_mass(random)))
    chain = Chain("random", tuple(Fraction(float(x)) for x in random.normal(size=3)), tuple(links), base=base)
    frames = move(chain, q, 0 * q, 0 * q).links
    found = []
    for k in range(cuts):
        one, other = random.choice([BASE, *(link.name for link in links)], 2, replace=False)
        far = _row(random)
        there = move(Chain("c", NONE, tuple(links), (Cut("", Frame(one, far), Frame(other, far)),)), q, 0 * q, 0 * q).cuts[0][1]
        pose = np.linalg.solve(frames[one][0], there[0]).real
        found.append(Cut(f"cut {k}", Frame(str(one), _row_of(pose)), Frame(str(other), far)))
    hung = [Effector(f"tool {k}", Frame(f"link {random.integers(0, size)}", _row(random)), NONE, NONE) for k in range(effectors)]
    independents = tuple(Independent(link.name) for link in links)
    whole = Chain("random", chain.gravity, tuple(links), tuple(found), tuple(hung), independents, base=base)
    return whole, q
