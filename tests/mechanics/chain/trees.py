"""Random chains whose cuts are closed in a random pose; and the mechanisms of S2."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np

from codegen.spec.chain import BASE, Chain, Cut, Effector, Frame, Link, Row
from codegen.spec.chain_file import read_chain
from codegen.spec.chain_forces import Condition, EffectorForce, JointForce, Spring, Stop, WorldForce
from codegen.spec.chain_motions import Independent
from codegen.spec.scene import Limit
from tests.mechanics.chain.series import move

EXAMPLES = Path(__file__).parents[3] / "examples" / "chains"
NONE = (Fraction(0),) * 3


def example(name: str) -> Chain:
    """A mechanism of S2."""
    return read_chain((EXAMPLES / f"{name}.toml").read_text(), name)


def start(chain: Chain) -> np.ndarray:
    """The coordinates in the rows."""
    return np.array([float(link.coordinate) for link in chain.links])


def tree(
    seed: int, size: int, cuts: int, effectors: int, base: str = "fixed", screws: tuple[int, ...] = ()
) -> tuple[Chain, np.ndarray]:
    """A chain of revolute and prismatic joints, some of them screws, with a pose in which all its cuts are closed."""
    random = np.random.default_rng(seed)
    q = random.normal(size=size)
    links: list[Link] = []
    for k in range(size):
        earlier = random.integers(0, k) if k and random.random() < 0.4 else k - 1
        parent = BASE if k == 0 or random.random() < 0.1 else f"link {earlier}"
        kind = "prismatic" if random.random() < 0.3 else "revolute"
        links.append(Link(f"link {k}", parent, kind, _row(random), *_mass(random)))
    for k in screws:
        links[k] = replace(links[k], type="screw", pitch=Fraction(k + 2, 7))
    gravity = tuple(Fraction(float(x)) for x in random.normal(size=3))
    ends = [random.choice([BASE, *(link.name for link in links)], 2, replace=False) for _ in range(cuts)]
    closed = tuple(_closed(links, q, str(one), str(other), _row(random)) for one, other in ends)
    hung = [
        Effector(f"tool {k}", Frame(f"link {random.integers(0, size)}", _row(random)), NONE, NONE)
        for k in range(effectors)
    ]
    independents = tuple(Independent(link.name) for link in links)
    return Chain("random", gravity, tuple(links), closed, tuple(hung), independents, base=base), q


def loaded(chain: Chain) -> Chain:
    """A chain with forces of every kind on its first coordinates, its first effector and one on the base."""
    names, tool = [link.name for link in chain.links], chain.effectors[0].name
    wall = Effector("wall", Frame(BASE, Row(c=Fraction(2), a=Fraction(1, 3))), NONE, NONE)
    push, turn = (Fraction(1), Fraction(-2), Fraction(1, 2)), (Fraction(0), Fraction(3), Fraction(1))
    when = Condition(names[0], None, None, 1)
    return replace(
        chain,
        effectors=(replace(chain.effectors[0], force=turn, moment=push), wall),
        joint_forces=(
            JointForce(names[0], Fraction(2), Fraction(3), Fraction(1, 4), Fraction(1, 5)),
            JointForce(names[1], Fraction(9), when=when),
        ),
        effector_forces=(EffectorForce(tool, push, turn), EffectorForce(tool, turn, push, when)),
        world_forces=(WorldForce(tool, push, turn),),
        springs=(
            Spring((tool, "wall"), Fraction(7), Fraction(1, 2), Fraction(1, 3)),
            Spring(("wall", tool), Fraction(3), Fraction(0), Fraction(0)),
        ),
        stops=(
            Stop(names[0], Limit(None, Fraction(-1), Fraction(50), Fraction(2))),
            Stop(names[2], Limit(Fraction(-9), Fraction(-8), Fraction(5), Fraction(0))),
        ),
    )


def _row(random: np.random.Generator) -> Row:
    """Angles are right ones more often than not, many lengths are 0."""
    right = random.integers(-2, 3, 3) * math.pi / 2
    angles = np.where(random.random(3) < 0.6, right, random.normal(size=3))
    lengths = np.where(random.random(3) < 0.4, 0.0, random.normal(size=3))
    return Row(*(Fraction(float(value)) for pair in zip(angles, lengths, strict=True) for value in pair))


def _mass(random: np.random.Generator) -> tuple:
    if random.random() < 0.3:
        return Fraction(0), NONE, (NONE,) * 3
    square = random.normal(size=(3, 3))
    inertia = square @ square.T if random.random() < 0.5 else np.diag(random.uniform(1, 2, 3))
    centre = random.normal(size=3) * (random.random(3) < 0.6)
    exact = tuple(tuple(Fraction(float(inertia[min(i, k), max(i, k)])) for k in range(3)) for i in range(3))
    return Fraction(float(random.uniform(0.5, 2))), tuple(Fraction(float(x)) for x in centre), exact


def _closed(links: list[Link], q: np.ndarray, one: str, other: str, far: Row) -> Cut:
    """A cut between two links that is closed in the pose."""
    chain = Chain("open", NONE, tuple(links), (Cut("", Frame(one, far), Frame(other, far)),))
    moving = move(chain, q, 0 * q, 0 * q)
    pose = np.linalg.solve(moving.links[one][0], moving.cuts[0][1][0]).real
    return Cut(f"{one} to {other}", Frame(one, _row_of(pose)), Frame(other, far))


def _row_of(pose: np.ndarray) -> Row:
    """The six constants of a pose."""
    if 1 - abs(pose[2, 2]) < 1e-9:
        return _parallel_row_of(pose)
    alpha, psi, theta = math.acos(pose[2, 2]), math.atan2(pose[0, 2], -pose[1, 2]), math.atan2(pose[2, 0], pose[2, 1])
    directions = np.array([[0, 0, 1], [math.cos(psi), math.sin(psi), 0], pose[:3, 2]]).T
    c, a, d = np.linalg.solve(directions, pose[:3, 3])
    return Row(*(Fraction(float(value)) for value in (psi, c, alpha, a, theta, d)))


def _parallel_row_of(pose: np.ndarray) -> Row:
    """The same where z is parallel to that of the link."""
    x, y, z = pose[:3, 3].real
    psi, alpha, sense = math.atan2(y, x), 0.0 if pose[2, 2].real > 0 else math.pi, np.sign(pose[2, 2].real)
    theta = sense * (math.atan2(pose[1, 0].real, pose[0, 0].real) - psi)
    return Row(*(Fraction(float(value)) for value in (psi, z, alpha, math.hypot(x, y), theta, 0.0)))
