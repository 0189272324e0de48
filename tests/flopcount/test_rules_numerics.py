"""The formulas that are counted are the right ones: each block against differences on SO(3).

The constraint functions are written here anew, from their definitions (SPEC S1.1 and S1.2), and
differentiated by differences of fourth order along ``r + delta r``, ``A exp(delta pi~)`` and
``alpha + delta alpha``.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
import pytest
from numpy.typing import NDArray

from flopcount import paper
from flopcount.rules import conventional, parametric
from flopcount.rules.evaluate import evaluate
from flopcount.rules.expressions import Block, Part
from flopcount.rules.vectors import vectors_first

Array = NDArray[np.float64]
STEP = 2e-3
TOLERANCE = 1e-8
STENCIL = ((-2, 1 / 12), (-1, -8 / 12), (1, 8 / 12), (2, -1 / 12))
PLACES = ("r_i", "pi_i", "r_j", "pi_j")


def tilde(a: Array) -> Array:
    return np.cross(np.eye(3), a)


def turn(a: Array) -> Array:
    """Rotation by the vector a (Rodrigues)."""
    angle = float(np.linalg.norm(a))
    if angle == 0.0:
        return np.eye(3)
    n = tilde(a / angle)
    return np.asarray(np.eye(3) + np.sin(angle) * n + (1 - np.cos(angle)) * n @ n)


def about(axis: str, angle: float) -> Array:
    return turn(angle * np.eye(3)["xyz".index(axis)])


def slope(function: Callable[[float], Array]) -> Array:
    """Derivative at 0."""
    return np.asarray(sum(weight * function(k * STEP) for k, weight in STENCIL) / STEP)


def directional(function: Callable[[Array], Array], unit: Array) -> Array:
    """Derivative at 0 along a unit vector."""
    return slope(lambda t: function(t * unit))


@dataclass(frozen=True)
class State:
    """Poses, joint frames and coordinates."""

    r_i: Array
    A_i: Array
    r_j: Array
    A_j: Array
    s_i: Array
    C_i: Array
    s_j: Array
    C_j: Array
    alpha: Array

    def moved(self, v: Array, *, body_axes: bool) -> "State":
        """Vary (delta r_i, delta pi_i, delta r_j, delta pi_j, delta alpha)."""
        return replace(
            self,
            r_i=self.r_i + (self.A_i @ v[:3] if body_axes else v[:3]),
            A_i=self.A_i @ turn(v[3:6]),
            r_j=self.r_j + (self.A_j @ v[6:9] if body_axes else v[6:9]),
            A_j=self.A_j @ turn(v[9:12]),
            alpha=self.alpha + v[12:],
        )

    @property
    def d(self) -> Array:
        return np.asarray(self.r_j + self.A_j @ self.s_j - self.r_i - self.A_i @ self.s_i)

    @property
    def H(self) -> Array:
        return np.asarray(self.C_i.T @ self.A_i.T @ self.A_j @ self.C_j)


def random_state(seed: int, coordinates: int = 0) -> State:
    rng = np.random.default_rng(seed)

    def vector() -> Array:
        return rng.normal(size=3)

    return State(
        *(vector(), turn(vector()), vector(), turn(vector())),
        *(vector(), turn(vector()), vector(), turn(vector())),
        rng.uniform(0.3, 1.2, size=coordinates),
    )


Function = Callable[[State], Array]


def jacobian(function: Function, state: State, *, body_axes: bool) -> Array:
    def moved(v: Array) -> Array:
        return function(state.moved(v, body_axes=body_axes))

    return np.stack([directional(moved, unit) for unit in np.eye(12 + state.alpha.size)], axis=1)


def second_derivative(function: Function, multiplier: Array, state: State) -> Array:
    """d(phi_q^T lambda) along all variations, delta r in world axes."""

    def force(v: Array) -> Array:
        at = state.moved(v, body_axes=False)
        return np.asarray(jacobian(function, at, body_axes=False).T @ multiplier)

    return np.stack([directional(force, unit) for unit in np.eye(12)], axis=1)


def place(name: str) -> slice:
    if name in PLACES:
        return slice(3 * PLACES.index(name), 3 * PLACES.index(name) + 3)
    at = 12 + int(name.removeprefix("alpha_")) - 1
    return slice(at, at + 1)


def assemble_rows(blocks: tuple[Block, ...], values: Mapping[str, Array], size: int) -> Array:
    rows: dict[str, Array] = {}
    for block in blocks:
        value = evaluate(block.value, values)
        rows.setdefault(block.row, np.zeros((value.shape[0], size)))[:, place(block.column)] += value
    return np.vstack(list(rows.values()))


def assemble_square(blocks: tuple[Block, ...], values: Mapping[str, Array], size: int) -> Array:
    matrix = np.zeros((size, size))
    for block in blocks:
        matrix[place(block.row), place(block.column)] += evaluate(block.value, values)
    return matrix


def named(state: State) -> dict[str, Array]:
    """Values of the names in the expressions, multipliers and coordinates apart."""
    vectors = {"s_i": state.s_i, "s_j": state.s_j, "d_ij": state.d}
    for body, frame in (("i", state.C_i), ("j", state.C_j)):
        vectors |= {f"{axis}_{body}": frame[:, k] for k, axis in enumerate("fgh")}
    matrices = {"A_i": state.A_i, "A_j": state.A_j, "A_ij": state.A_i.T @ state.A_j}
    return {name: value.reshape(3, 1) for name, value in vectors.items()} | matrices


def scalar(value: float) -> Array:
    return np.array([[value]])


# Conventional


def axis_of(frame: Array, name: str) -> Array:
    return np.asarray(frame[:, "fgh".index(name[0])])


def dot_1(a: str, b: str) -> Function:
    return lambda x: np.array([(x.A_i @ axis_of(x.C_i, a)) @ (x.A_j @ axis_of(x.C_j, b))])


def dot_2(a: str) -> Function:
    return lambda x: np.array([(x.A_i @ axis_of(x.C_i, a)) @ x.d])


def spherical(x: State) -> Array:
    return x.d


CONVENTIONAL = [
    *((conventional.dot_1(a, b), dot_1(a, b)) for a, b in (("f_i", "h_j"), ("g_i", "h_j"), ("f_i", "g_j"))),
    (conventional.dot_1("h_i", "h_j"), dot_1("h_i", "h_j")),
    *((conventional.dot_2(a), dot_2(a)) for a in ("f_i", "g_i", "h_i")),
    (conventional.spherical(), spherical),
]


@pytest.mark.parametrize(("part", "function"), CONVENTIONAL, ids=lambda x: getattr(x, "label", ""))
def test_conventional_blocks(part: Part, function: Function) -> None:
    state = random_state(1)
    multiplier = np.array([0.7, -1.3, 0.4])[: function(state).size]
    values = named(state) | {"lambda": multiplier.reshape(-1, 1)}
    expected = jacobian(function, state, body_axes=False)
    assert np.abs(assemble_rows(part.phi_q, values, 12) - expected).max() < TOLERANCE
    expected = second_derivative(function, multiplier, state)
    assert np.abs(assemble_square(part.phi_q_t_lambda_q, values, 12) - expected).max() < TOLERANCE


PITCH, MULTIPLIER = 0.31, -1.7


def screw_values(state: State) -> dict[str, Array]:
    return named(state) | {
        "lambda": scalar(MULTIPLIER),
        "p lambda": scalar(PITCH * MULTIPLIER),
        "p h_i": PITCH * state.C_i[:, 2:],
    }


def screw(x: State) -> Array:
    """The angle is that of the joint frames about their common axis."""
    return np.asarray(dot_2("h_i")(x) - PITCH * np.arctan2(x.H[1, 0], x.H[0, 0]))


def aligned(state: State, angle: float) -> State:
    return replace(state, A_j=state.A_i @ state.C_i @ about("z", angle) @ state.C_j.T)


def test_screw_jacobian_on_the_manifold() -> None:
    state = aligned(random_state(2), 0.8)
    part = conventional.screw()
    expected = jacobian(screw, state, body_axes=False)
    assert np.abs(assemble_rows(part.phi_q, screw_values(state), 12) - expected).max() < TOLERANCE


def test_screw_second_derivative_is_that_of_its_jacobian() -> None:
    """Everywhere, with ``delta theta = h_i . (A_ij delta pi_j - delta pi_i)``."""
    state = random_state(3)

    def turning(v: Array) -> Array:
        x, h = state.moved(v, body_axes=False), state.C_i[:, 2]
        return np.concatenate([np.zeros(3), -h, np.zeros(3), x.A_j.T @ x.A_i @ h])

    expected = second_derivative(dot_2("h_i"), np.array([MULTIPLIER]), state)
    change = np.stack([directional(turning, unit) for unit in np.eye(12)], axis=1)
    expected -= PITCH * MULTIPLIER * change
    blocks = assemble_square(conventional.screw().phi_q_t_lambda_q, screw_values(state), 12)
    assert np.abs(blocks - expected).max() < TOLERANCE


def test_screw_second_derivative_on_tangent_directions() -> None:
    """Along motions that keep the axes parallel it is the second derivative of the constraint itself."""
    state = aligned(random_state(4), -0.6)
    expected = second_derivative(screw, np.array([MULTIPLIER]), state)
    blocks = assemble_square(conventional.screw().phi_q_t_lambda_q, screw_values(state), 12)
    A_ij, h = state.A_i.T @ state.A_j, state.C_i[:, 2]
    tangent = np.zeros((12, 10))
    tangent[0:3, 0:3] = tangent[6:9, 3:6] = tangent[3:6, 6:9] = np.eye(3)
    tangent[9:12, 6:9] = A_ij.T
    tangent[9:12, 9] = A_ij.T @ h
    assert np.abs((blocks - expected) @ tangent).max() < TOLERANCE
    assert np.abs(blocks - expected).max() > 0.1  # and across the manifold it is not


# Parametric


def relative_rotation(angles: Array) -> Array:
    """H(alpha) of Table 3, as matrices."""
    axes = ("", "z", "zx", "zyx")[angles.size]
    H = np.eye(3)
    for axis, angle in zip(axes, angles, strict=True):
        H = H @ about(axis, float(angle))
    return H


def rotation_rows(H: Array, alpha: Array) -> Array:
    """Table 4, row by row."""
    ff, fg, fh = H[0]
    gf, gg, gh = H[1]
    hf, hg, hh = H[2]
    del gf, gg, hg
    c, s = np.cos(alpha), np.sin(alpha)
    match alpha.size:
        case 0:
            return np.array([gh, hf, fg])
        case 1:
            return np.array([fh, gh, ff - c[0]])
        case 2:
            return np.array([hf, ff - c[0], hh - c[1]])
        case _:
            return np.array([ff - c[0] * c[1], hf + s[1], hh - c[1] * c[2]])


@dataclass(frozen=True)
class Joint:
    """A parametric joint: how its coordinates place body j."""

    translations: int
    rotations: int
    pitched: bool = False

    @property
    def coordinates(self) -> int:
        return 1 if self.pitched else self.translations + self.rotations

    @property
    def parts(self) -> tuple[Part, Part]:
        if self.pitched:
            return parametric.translation(1, 1, pitched=True), parametric.rotation(1)
        return (
            parametric.translation(self.translations, self.rotations),
            parametric.rotation(self.rotations, self.translations),
        )

    def angles(self, alpha: Array) -> Array:
        return alpha if self.pitched else alpha[self.translations :]

    def displacement(self, state: State) -> Array:
        """d'(alpha) of Table 3, in the axes of body i."""
        f, g, h = state.C_i.T
        if self.pitched:
            return np.asarray(h * PITCH * (state.alpha[0] + 2 * np.pi + 0.4))
        axes = ((), (h,), (f, g), (f, g, h))[self.translations]
        pairs = zip(state.alpha[: len(axes)], axes, strict=True)
        return np.asarray(sum((a * v for a, v in pairs), np.zeros(3)))

    def phi(self, state: State) -> Array:
        gap = state.A_i.T @ state.d - self.displacement(state)
        return np.concatenate([gap, rotation_rows(state.H, self.angles(state.alpha))])

    def closed(self, state: State) -> State:
        """Place body j so that the constraints hold."""
        A_j = state.A_i @ state.C_i @ relative_rotation(self.angles(state.alpha)) @ state.C_j.T
        r_j = state.r_i + state.A_i @ (state.s_i + self.displacement(state)) - A_j @ state.s_j
        return replace(state, A_j=A_j, r_j=r_j)

    def values(self, state: State, multiplier: Array) -> dict[str, Array]:
        values = named(state) | {"p h_i": PITCH * state.C_i[:, 2:], "lambda": multiplier[:3].reshape(3, 1)}
        scalars = {"p": PITCH, "2 pi n": 2 * np.pi, "alpha_0": 0.4}
        scalars |= {"alpha": state.alpha[0]} if self.pitched else {}
        scalars |= {f"alpha_{k + 1}": a for k, a in enumerate(state.alpha)}
        scalars |= {f"lambda_{k + 1}": multiplier[3 + k] for k in range(3)}
        angles = self.angles(state.alpha)
        for k, angle in enumerate(angles):
            scalars |= {f"c{k + 1}": np.cos(angle), f"s{k + 1}": np.sin(angle)}
            turned = directional(lambda v: relative_rotation(angles + v), np.eye(angles.size)[k])
            values[f"D_{k + 1}"] = state.C_i @ turned @ state.C_j.T
        return values | {name: scalar(float(value)) for name, value in scalars.items()}


PAIRS = [Joint(k, m) for k in range(4) for m in range(4)]
JOINTS = [*PAIRS, Joint(1, 1, pitched=True)]


def label(joint: object) -> str:
    assert isinstance(joint, Joint)
    return f"trn{joint.translations}+rot{joint.rotations}{' pitched' * joint.pitched}"


@pytest.mark.parametrize("joint", JOINTS, ids=label)
def test_parametric_jacobian_on_the_manifold(joint: Joint) -> None:
    state = joint.closed(random_state(5, joint.coordinates))
    assert np.abs(joint.phi(state)).max() < 1e-12
    values, size = joint.values(state, np.zeros(6)), 12 + joint.coordinates
    rows = [assemble_rows(part.phi_q, values, size) for part in joint.parts]
    assert np.abs(np.vstack(rows) - jacobian(joint.phi, state, body_axes=True)).max() < TOLERANCE


@pytest.mark.parametrize("joint", JOINTS, ids=label)
def test_parametric_second_derivative_substituted(joint: Joint) -> None:
    """phi_q on the manifold depends on alpha alone; its derivative is taken along alpha."""
    state = joint.closed(random_state(6, joint.coordinates))
    multiplier = np.array([0.7, -1.3, 0.4, 1.1, -0.6, 0.9])

    def force(v: Array) -> Array:
        at = joint.closed(replace(state, alpha=state.alpha + v))
        return np.asarray(jacobian(joint.phi, at, body_axes=True).T @ multiplier)

    size = 12 + joint.coordinates
    expected = np.zeros((size, size))
    for k, unit in enumerate(np.eye(joint.coordinates)):
        expected[:, 12 + k] = directional(force, unit)
    values = joint.values(state, multiplier)
    blocks = sum(assemble_square(part.phi_q_t_lambda_q, values, size) for part in joint.parts)
    assert np.abs(blocks - expected).max() < TOLERANCE


@pytest.mark.parametrize("joint", [Joint(1, 1), Joint(0, 3)], ids=label)
def test_parametric_jacobian_depends_on_alpha_alone(joint: Joint) -> None:
    first = joint.closed(random_state(7, joint.coordinates))
    other = random_state(8, joint.coordinates)
    second = joint.closed(replace(first, r_i=other.r_i, A_i=other.A_i))
    at_first, at_second = (jacobian(joint.phi, x, body_axes=True) for x in (first, second))
    assert np.abs(at_first - at_second).max() < TOLERANCE


@pytest.mark.parametrize("name", paper.JOINTS)
def test_joints_are_made_of_the_parts_checked_here(name: str) -> None:
    composition = paper.TABLE_5[name]
    checked = Joint(composition.translation, composition.rotation, pitched=name == "screw")
    assert parametric.joint(name) == checked.parts
    known = {part.label: part for part, _ in CONVENTIONAL} | {"screw(h_i, d_ij, theta)": conventional.screw()}
    assert all(known[part.label] == part for part in conventional.JOINTS[name])


@pytest.mark.parametrize("rotations", [1, 2, 3])
def test_zero_row_holds_for_joint_axes_parallel_to_the_body_axes_only(rotations: int) -> None:
    joint = Joint(0, rotations)
    state = joint.closed(random_state(9, rotations))
    parallel = joint.closed(replace(state, C_i=np.eye(3)))
    assert np.abs(joint.values(parallel, np.zeros(6))["D_1"][2]).max() < TOLERANCE
    assert np.abs(joint.values(state, np.zeros(6))["D_1"][2]).min() > 1e-3


# Vectors first


@pytest.mark.parametrize("part", [*(part for part, _ in CONVENTIONAL), conventional.screw()], ids=lambda p: p.label)
def test_vectors_first_regroups_without_changing_the_value(part: Part) -> None:
    state = random_state(10)
    values = screw_values(state)
    if part.name == "spherical":
        values["lambda"] = np.array([[0.7], [-1.3], [0.4]])
    for block in (*part.phi_q, *part.phi_q_t_lambda_q):
        regrouped = vectors_first(block.value, part.carrier)
        assert np.abs(evaluate(block.value, values) - evaluate(regrouped, values)).max() < 1e-12


@pytest.mark.parametrize("joint", JOINTS, ids=label)
def test_vectors_first_keeps_the_value_of_parametric_blocks(joint: Joint) -> None:
    state = joint.closed(random_state(11, joint.coordinates))
    values = joint.values(state, np.array([0.7, -1.3, 0.4, 1.1, -0.6, 0.9]))
    for part in joint.parts:
        for block in (*part.phi_q, *part.phi_q_t_lambda_q):
            regrouped = vectors_first(block.value, part.carrier)
            assert np.abs(evaluate(block.value, values) - evaluate(regrouped, values)).max() < 1e-12
