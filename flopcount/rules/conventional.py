"""The conventional method: the four basic constraints and the joints that they make (S1 eqs 4 to 9).

Input: names of the vectors. Output: `Part`s. Variations: (delta r_i, delta pi_i, delta r_j, delta pi_j),
delta r in world axes, delta pi in body axes. Blocks of dot-2 are grouped as the paper prints them in eqs (8)
and (9), with their misprints corrected, and those of screw alike. The paper prints none of dot-1 and
spherical; they are grouped as they come out of the differentiation, with skew matrices of turned vectors.
d_ij is in world axes, all other vectors are fixed in their body and in its axes; A_ij = A_i^T A_j.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

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
)

A_I, A_J, A_IJ = Mat("A_i"), Mat("A_j"), Mat("A_ij")
A_I_T, A_J_T, A_IJ_T = Transpose(A_I), Transpose(A_J), Transpose(A_IJ)
S_I, S_J, D_IJ = Vec("s_i"), Vec("s_j"), Vec("d_ij")
LAMBDA = Scalar("lambda")
LAMBDA_P = Scalar("p lambda")
"""The multiplier times the pitch (advance per radian): again a multiplier, and free."""


def dot_1(first: str, second: str) -> Part:
    """Constraint ``first . second = 0`` of a vector of body i and one of body j."""
    a, b = Vec(first), Vec(second)
    mixed = _scaled(Skew(b), A_IJ_T, Skew(a))
    return Part(
        name="dot-1",
        label=f"dot-1({first}, {second})",
        phi_q=(
            Block("dot-1", "pi_i", Negate(Product((Transpose(b), A_IJ_T, Skew(a))))),
            Block("dot-1", "pi_j", Negate(Product((Transpose(a), A_IJ, Skew(b))))),
        ),
        phi_q_t_lambda_q=(
            Block("pi_i", "pi_i", _scaled(Skew(a), Skew(Product((A_IJ, b))))),
            Block("pi_j", "pi_i", Negate(mixed)),
            Block("pi_i", "pi_j", Negate(_scaled(Skew(a), A_IJ, Skew(b)))),
            Block("pi_j", "pi_j", _scaled(Skew(b), Skew(Product((A_IJ_T, a))))),
        ),
        carrier=first,
    )


def dot_2(first: str) -> Part:
    """Constraint ``first . d_ij = 0`` of a vector of body i and d_ij (eqs 8 and 9, corrected)."""
    name, a = "dot-2", Vec(first)
    return Part(
        name=name,
        label=f"dot-2({first}, d_ij)",
        phi_q=_dot_2_rows(name, a),
        phi_q_t_lambda_q=_dot_2_blocks(a, Negate(_scaled(Skew(S_J), A_IJ_T, Skew(a)))),
        carrier=first,
    )


def spherical() -> Part:
    """Constraint ``d_ij = 0``: three rows in world axes; lambda is a vector."""
    name, multiplier = "spherical", Vec("lambda")
    return Part(
        name=name,
        label=name,
        phi_q=(
            Block(name, "r_i", Negate(IDENTITY)),
            Block(name, "pi_i", Product((A_I, Skew(S_I)))),
            Block(name, "r_j", IDENTITY),
            Block(name, "pi_j", Negate(Product((A_J, Skew(S_J))))),
        ),
        phi_q_t_lambda_q=(
            Block("pi_i", "pi_i", Negate(Product((Skew(S_I), Skew(Product((A_I_T, multiplier))))))),
            Block("pi_j", "pi_j", Product((Skew(S_J), Skew(Product((A_J_T, multiplier)))))),
        ),
    )


def screw() -> Part:
    """Constraint ``h_i . d_ij - p (theta + 2 pi n + theta_0) = 0``, p the advance per radian.

    Dot-2 of h_i, less p times ``delta theta = h_i^T (A_ij delta pi_j - delta pi_i)``, which holds on the
    manifold (h_i parallel to h_j). That form is not symmetric: the block (pi_j, pi_i) has a term with p that
    (pi_i, pi_j) lacks. The paper does not print these blocks; what they cost depends on where p is written
    (R4 in `flopcount.rules.convention`).
    """
    name, h = "screw", Vec("h_i")
    pitch = Transpose(Vec("p h_i"))
    r_i, pi_i, r_j, pi_j = _dot_2_rows(name, h)
    mixed = Sum(
        (
            Negate(_scaled(Skew(S_J), A_IJ_T, Skew(h))),
            Scale(LAMBDA_P, Product((A_IJ_T, Skew(h)))),
        )
    )
    return Part(
        name=name,
        label="screw(h_i, d_ij, theta)",
        phi_q=(
            r_i,
            Block(name, "pi_i", Sum((pi_i.value, pitch))),
            r_j,
            Block(name, "pi_j", Sum((pi_j.value, Negate(Product((pitch, A_IJ)))))),
        ),
        phi_q_t_lambda_q=_dot_2_blocks(h, mixed),
        carrier="h_i",
    )


def _dot_2_rows(name: str, a: Vec) -> tuple[Block, Block, Block, Block]:
    along = Product((Transpose(a), A_I_T))
    bracket = Sum((Product((A_I_T, Skew(D_IJ), A_I)), Skew(S_I)))
    return (
        Block(name, "r_i", Negate(along)),
        Block(name, "pi_i", Product((Transpose(a), bracket))),
        Block(name, "r_j", along),
        Block(name, "pi_j", Negate(Product((Transpose(a), A_IJ, Skew(S_J))))),
    )


def _dot_2_blocks(a: Vec, mixed: Expr) -> tuple[Block, ...]:
    """Blocks of eq. (9), column by column; ``mixed`` is (pi_j, pi_i), and (pi_j, pi_j) is -mixed A_ij."""
    bracket = Sum((Product((A_I_T, Skew(D_IJ), A_I)), Skew(S_I)))
    turned = _scaled(A_I, Skew(a))
    turned_back = _scaled(Skew(a), A_I_T)
    return (
        Block("pi_i", "r_i", Negate(turned_back)),
        Block("r_i", "pi_i", turned),
        Block("pi_i", "pi_i", _scaled(Skew(a), bracket)),
        Block("r_j", "pi_i", Negate(turned)),
        Block("pi_j", "pi_i", mixed),
        Block("pi_i", "r_j", turned_back),
        Block("pi_i", "pi_j", Negate(_scaled(Skew(a), A_IJ, Skew(S_J)))),
        Block("pi_j", "pi_j", Negate(Product((mixed, A_IJ)))),
    )


def _scaled(*factors: Expr) -> Expr:
    return Scale(LAMBDA, Product(factors))


BASIC: Mapping[str, Part] = MappingProxyType(
    {
        "dot-1": dot_1("f_i", "h_j"),
        "dot-2": dot_2("f_i"),
        "spherical": spherical(),
        "screw": screw(),
    }
)
"""The four basic constraints of Table 2."""

_UPRIGHT = (dot_1("f_i", "h_j"), dot_1("g_i", "h_j"))
_AXIAL = (dot_2("f_i"), dot_2("g_i"))

JOINTS: Mapping[str, tuple[Part, ...]] = MappingProxyType(
    {
        "revolute": (spherical(), *_UPRIGHT),
        "translational": (*_UPRIGHT, dot_1("f_i", "g_j"), *_AXIAL),
        "screw": (*_AXIAL, *_UPRIGHT, screw()),
        "cylindrical": (*_AXIAL, *_UPRIGHT),
        "universal": (spherical(), dot_1("h_i", "h_j")),
        "planar": (*_UPRIGHT, dot_2("h_i")),
        "ball": (spherical(),),
    }
)
"""The joints of Table 1, with their vectors."""
