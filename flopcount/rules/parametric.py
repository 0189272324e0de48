"""The parametric method: the trn and rot constraints and the joints that they make (S1 eqs 13 to 38).

Input: numbers of coordinates. Output: `Part`s. Variations: (delta r'_i, delta pi_i, delta r'_j, delta pi_j,
delta alpha), all in body axes. Both derivatives are the paper's *substituted* ones: ``A_ij = C_i H(alpha)
C_j^T`` is inserted in phi_q, which then depends on alpha alone. The rows of rot are those of Table 4.
Nothing is transcribed from eqs (20) to (38): with H(alpha) of Table 3, the row ``a_i . b_j`` of rot has
``phi_pi_i = (a x H b)^T C_i^T``, ``phi_pi_j = (b x H^T a)^T C_j^T`` and ``phi_alpha = -d(H_ab)/d alpha``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache

from flopcount.paper import TABLE_5
from flopcount.rules import trig
from flopcount.rules.expressions import (
    IDENTITY,
    Block,
    Expr,
    Mat,
    Negate,
    Part,
    Product,
    Scalar,
    Scale,
    Skew,
    Sum,
    Transpose,
    Vec,
    total,
)
from flopcount.rules.trig import Matrix, Polynomial, Vector

TRANSLATION_AXES = ("", "h", "fg", "fgh")
"""Table 3: the joint axes, fixed in body i, along which trn0 to trn3 allow a displacement."""

ROTATION_AXES = ("", "z", "zx", "zyx")
"""Table 3: the elementary rotations of which rot0 to rot3 are made."""

ROTATION_ROWS = (("gh", "hf", "fg"), ("fh", "gh", "ff"), ("hf", "ff", "hh"), ("ff", "hf", "hh"))
"""Table 4: each row is an axis of frame i times an axis of frame j, less their product in H(alpha)."""

PITCHED_ALPHA = Product((Scalar("p"), Sum((Scalar("alpha"), Scalar("2 pi n"), Scalar("alpha_0")))))
"""The displacement of the screw joint: ``p (alpha + 2 pi n + alpha_0)``."""


def translation(axes: int, rotations: int, pitched: bool = False) -> Part:
    """Constraint trn: ``A_i^T d_ij - d'(alpha) = 0`` (eqs 20 to 26).

    Args:
        axes: number of translational coordinates, 0 to 3.
        rotations: number of rotational coordinates of the joint, on which A_ij depends.
        pitched: True for the screw joint, whose displacement follows its rotation.
    """
    name = f"trn{axes}"
    vectors = [Vec(f"{axis}_i") for axis in TRANSLATION_AXES[axes]]
    sizes: list[Expr] = [PITCHED_ALPHA] if pitched else [Scalar(f"alpha_{k + 1}") for k in range(axes)]
    arms: list[Expr] = [Vec("p h_i")] if pitched else list(vectors)
    reach = total([Skew(Vec("s_i")), *(Scale(size, Skew(v)) for size, v in zip(sizes, vectors, strict=True))])
    return Part(
        name=name,
        label=f"{name} with pitch" if pitched else name,
        phi_q=(
            Block(name, "r_i", Negate(IDENTITY)),
            Block(name, "pi_i", reach),
            Block(name, "r_j", Mat("A_ij")),
            Block(name, "pi_j", Negate(Product((Mat("A_ij"), Skew(Vec("s_j")))))),
            *(Block(name, f"alpha_{k + 1}", Negate(arm)) for k, arm in enumerate(arms)),
        ),
        phi_q_t_lambda_q=tuple(_translation_second(arms, rotations, 0 if pitched else axes)),
    )


def rotation(angles: int, offset: int = 0) -> Part:
    """Constraint rot with the rows of Table 4 (eqs 31 to 38).

    Args:
        angles: number of rotational coordinates, 0 to 3.
        offset: number of coordinates of the joint that come before them.
    """
    name = f"rot{angles}"
    return Part(
        name=name,
        label=name,
        phi_q=tuple(_rotation_rows(angles, offset)),
        phi_q_t_lambda_q=(*_rotation_second(angles, offset), *_rotation_second_alpha(angles, offset)),
    )


def _translation_second(arms: list[Expr], rotations: int, offset: int) -> Iterator[Block]:
    multiplier = Vec("lambda")
    for k, arm in enumerate(arms):
        yield Block("pi_i", f"alpha_{k + 1}", Negate(Product((Skew(arm), multiplier))))
    for k in range(rotations):
        column, slope = f"alpha_{offset + k + 1}", Transpose(Mat(f"D_{k + 1}"))
        yield Block("r_j", column, Product((slope, multiplier)))
        yield Block("pi_j", column, Product((Skew(Vec("s_j")), slope, multiplier)))


def orientation(angles: int) -> Matrix:
    """H(alpha) of Table 3 as polynomials in the cosines and sines of its angles."""
    matrix = trig.identity()
    for k, axis in enumerate(ROTATION_AXES[angles]):
        matrix = trig.matrix_product(matrix, trig.elementary(axis, k + 1))
    return matrix


def _arms(angles: int) -> list[tuple[Vector, Vector, Polynomial]]:
    """For each row: phi_pi_i in frame i, phi_pi_j in frame j, and the entry of H that the row prescribes."""
    H, result = orientation(angles), []
    for row in ROTATION_ROWS[angles]:
        a, b = ("fgh".index(axis) for axis in row)
        column: Vector = (H[0][b], H[1][b], H[2][b])
        result.append((trig.unit_cross(a, column), trig.unit_cross(b, H[a]), H[a][b]))
    return result


def _rotation_rows(angles: int, offset: int) -> Iterator[Block]:
    for k, (on_i, on_j, entry) in enumerate(_arms(angles)):
        row = f"rot{angles} row {k + 1}"
        yield Block(row, "pi_i", _combination(on_i, "i", transposed=True))
        yield Block(row, "pi_j", _combination(on_j, "j", transposed=True))
        for m in range(angles):
            slope = trig.minus(trig.derivative(entry, m + 1))
            if slope:
                yield Block(row, f"alpha_{offset + m + 1}", trig.expression(slope, _ascending))


def _rotation_second(angles: int, offset: int) -> Iterator[Block]:
    """(Phi_Z^T lambda)_alpha, column by column (eq. 36)."""
    arms = _arms(angles)
    for m in range(angles):
        for body, sides in (("i", [on_i for on_i, _, _ in arms]), ("j", [on_j for _, on_j, _ in arms])):
            slope = [_weighted([side[axis] for side in sides], m + 1) for axis in range(3)]
            if any(slope):
                block = _combination((slope[0], slope[1], slope[2]), body, transposed=False)
                yield Block(f"pi_{body}", f"alpha_{offset + m + 1}", block)


def _rotation_second_alpha(angles: int, offset: int) -> Iterator[Block]:
    """(Phi_alpha^T lambda)_alpha, column by column (eq. 37)."""
    entries = [entry for _, _, entry in _arms(angles)]
    for m in range(angles):
        for k in range(angles):
            slope = _weighted([trig.minus(trig.derivative(entry, k + 1)) for entry in entries], m + 1)
            if slope:
                place = (f"alpha_{offset + k + 1}", f"alpha_{offset + m + 1}")
                yield Block(*place, trig.expression(slope, _ascending))


def _weighted(rows: list[Polynomial], angle: int) -> Polynomial:
    """d/d alpha of the sum of lambda_k times row k."""
    weighted = (trig.times(trig.variable(f"lambda_{k + 1}"), row) for k, row in enumerate(rows))
    return trig.derivative(trig.plus(*weighted), angle)


def _combination(components: Vector, body: str, *, transposed: bool) -> Expr:
    """A combination of f, g, h of one body.

    The angle that acts last on a body's axes stands last in a product: alpha_1 for body i, the last one for
    body j.
    """
    order = _descending if body == "i" else _ascending
    terms: list[Expr] = []
    for axis, coefficient in zip("fgh", components, strict=True):
        vector = Vec(f"{axis}_{body}")
        if coefficient:
            terms.append(_multiple(coefficient, Transpose(vector) if transposed else vector, order))
    return total(terms)


def _multiple(coefficient: Polynomial, vector: Expr, order: Callable[[str], tuple[int, int]]) -> Expr:
    """A vector times a polynomial that is not zero; a coefficient of +1 or -1 is a sign."""
    negative = len(coefficient) == 1 and min(coefficient.values()) < 0
    positive = trig.minus(coefficient) if negative else coefficient
    multiple = vector if tuple(positive) == ((),) else Scale(trig.expression(positive, order), vector)
    return Negate(multiple) if negative else multiple


def _ascending(name: str) -> tuple[int, int]:
    return (0, 0) if name.startswith("lambda") else (1, int(name[1:]))


def _descending(name: str) -> tuple[int, int]:
    first, angle = _ascending(name)
    return first, -angle


@cache
def joint(name: str) -> tuple[Part, ...]:
    """The parts of a joint of Table 5 (corrected): trn and rot.

    Raises:
        KeyError: there is no such joint.
    """
    composition = TABLE_5[name]
    if name == "screw":
        return translation(1, 1, pitched=True), rotation(1)
    return (
        translation(composition.translation, composition.rotation),
        rotation(composition.rotation, composition.translation),
    )
