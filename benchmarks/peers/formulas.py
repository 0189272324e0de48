"""The closed formulas of the derivatives, S1 Eqs. (5) to (10) with the signs corrected.

For the basic constraints a_i . b_j (dot-1), a_i . d_ij (dot-2), d_ij (spherical) and the screw: blocks of phi_q and
of (phi_q^T lambda)_q in the virtual displacements (delta r_i world, delta pi_i body, delta r_j world, delta pi_j body),
written with skew matrices. `lambda_first` adds up the axes of constraints of one kind, multiplied by their lambda,
before they enter the formula, which is linear in them.
"""

from __future__ import annotations

from dataclasses import dataclass

from benchmarks.peers.constraint import ROWS, Geometry, Pose
from benchmarks.peers.linear import (
    Matrix,
    Scalar,
    Vector,
    add,
    apply,
    dot,
    identity,
    multiply,
    negative,
    opposite,
    product,
    scaled,
    sum_of,
    tilde,
    transpose,
    zeros,
)

Blocks = dict[tuple[int, int], Matrix]
"""Nonzero 3 x 3 blocks of a 12 x 12 matrix; displacements in the order r_i, pi_i, r_j, pi_j."""


@dataclass(frozen=True, slots=True)
class Closed:
    """The formulas of one joint at one pose."""

    pose: Pose
    geometry: Geometry

    @property
    def A_ij(self) -> Matrix:
        """Body j to body i."""
        return product(transpose(self.pose.A_i), self.pose.A_j)

    def d_ij(self) -> Vector:
        """From the joint origin on body i to the one on body j, world axes, m."""
        pose, geometry = self.pose, self.geometry
        outward = [pose.r_j, apply(pose.A_j, geometry.s_j)]
        return sum_of([*outward, opposite(pose.r_i), opposite(apply(pose.A_i, geometry.s_i))])

    def dot1_row(self, a: Vector, b: Vector) -> Vector:
        """Row of phi_q of a_i . b_j: [0, -b^T A_ij^T a~, 0, -a^T A_ij b~]."""
        A_ij = self.A_ij
        on_i = opposite(apply(transpose(tilde(a)), apply(A_ij, b)))
        on_j = opposite(apply(transpose(tilde(b)), apply(transpose(A_ij), a)))
        return [0, 0, 0, *on_i, 0, 0, 0, *on_j]

    def dot1_second(self, a: Vector, b: Vector) -> Blocks:
        """Derivative of the transposed row of a_i . b_j."""
        A_ij = self.A_ij
        return {
            (1, 1): product(tilde(a), tilde(apply(A_ij, b))),
            (1, 3): negative(product(product(tilde(a), A_ij), tilde(b))),
            (3, 1): negative(product(product(tilde(b), transpose(A_ij)), tilde(a))),
            (3, 3): product(tilde(b), tilde(apply(transpose(A_ij), a))),
        }

    def dot2_row(self, a: Vector) -> Vector:
        """Row of phi_q of a_i . d_ij: [-a^T A_i^T, -d^T A_i a~ + a^T s_i~, a^T A_i^T, -a^T A_ij s_j~]."""
        world = apply(self.pose.A_i, a)
        relative = apply(transpose(self.pose.A_i), self.d_ij())
        turned = opposite(apply(transpose(tilde(a)), relative))
        on_i = sum_of([turned, apply(transpose(tilde(self.geometry.s_i)), a)])
        on_j = opposite(apply(transpose(tilde(self.geometry.s_j)), apply(transpose(self.A_ij), a)))
        return [*opposite(world), *on_i, *world, *on_j]

    def dot2_second(self, a: Vector) -> Blocks:
        """Derivative of the transposed row of a_i . d_ij."""
        A_i, A_ij, s_j = self.pose.A_i, self.A_ij, self.geometry.s_j
        e = sum_of([apply(transpose(A_i), self.d_ij()), self.geometry.s_i])
        moved, turned = product(A_i, tilde(a)), product(tilde(a), transpose(A_i))
        return {
            (0, 1): moved,
            (1, 0): negative(turned),
            (1, 1): product(tilde(a), tilde(e)),
            (1, 2): turned,
            (1, 3): negative(product(product(tilde(a), A_ij), tilde(s_j))),
            (2, 1): negative(moved),
            (3, 1): negative(product(product(tilde(s_j), transpose(A_ij)), tilde(a))),
            (3, 3): product(tilde(s_j), tilde(apply(transpose(A_ij), a))),
        }

    def spherical_rows(self) -> Matrix:
        """Rows of phi_q of d_ij: [-I, A_i s_i~, I, -A_j s_j~]."""
        on_i = product(self.pose.A_i, tilde(self.geometry.s_i))
        on_j = negative(product(self.pose.A_j, tilde(self.geometry.s_j)))
        eye = identity()
        return [[*p, *q, *r, *s] for p, q, r, s in zip(negative(eye), on_i, eye, on_j, strict=True)]

    def spherical_second(self, multiplier: Vector) -> Blocks:
        """Derivative of phi_q^T lambda of d_ij."""
        force_i = apply(transpose(self.pose.A_i), multiplier)
        force_j = apply(transpose(self.pose.A_j), multiplier)
        return {
            (1, 1): negative(product(tilde(self.geometry.s_i), tilde(force_i))),
            (3, 3): product(tilde(self.geometry.s_j), tilde(force_j)),
        }

    def angle(self) -> tuple[Scalar, Scalar, Vector, Vector]:
        """Sine and cosine (up to a common factor) of the screw's angle, and their rows."""
        f_j = self.geometry.axes_j["f"]
        f_i, g_i = self.geometry.axes_i["f"], self.geometry.axes_i["g"]
        turned = apply(self.A_ij, f_j)
        return dot(g_i, turned), dot(f_i, turned), self.dot1_row(g_i, f_j), self.dot1_row(f_i, f_j)

    def angle_row(self) -> Vector:
        """Derivative of the screw's angle atan2(y, x): (x y_q - y x_q) / (x^2 + y^2)."""
        y, x, y_q, x_q = self.angle()
        square = x * x + y * y
        return [0 if _none(p, q) else (x * p - y * q) / square for p, q in zip(y_q, x_q, strict=True)]

    def angle_second(self) -> Blocks:
        """Derivative of the transposed `angle_row`."""
        y, x, y_q, x_q = self.angle()
        square = x * x + y * y
        f_j = self.geometry.axes_j["f"]
        y_qq = self.dot1_second(self.geometry.axes_i["g"], f_j)
        x_qq = self.dot1_second(self.geometry.axes_i["f"], f_j)
        row = self.angle_row()
        rate = [0 if _none(p, q) else 2 * (x * p + y * q) / square for p, q in zip(x_q, y_q, strict=True)]
        return {
            (m, n): [
                [
                    (x_q[k] * y_q[l] - y_q[k] * x_q[l] + x * y_qq[m, n][l % 3][k % 3] - y * x_qq[m, n][l % 3][k % 3])
                    / square
                    - row[l] * rate[k]
                    for k in range(3 * n, 3 * n + 3)
                ]
                for l in range(3 * m, 3 * m + 3)  # noqa: E741
            ]
            for m, n in y_qq
        }


def _none(p: Scalar, q: Scalar) -> bool:
    return isinstance(p, int) and isinstance(q, int)


def phi_q(joint: str, closed: Closed) -> Matrix:
    """phi_q [rows x 12]."""
    axes_i, axes_j = closed.geometry.axes_i, closed.geometry.axes_j
    rows: Matrix = []
    for row in ROWS[joint]:
        if row == "d":
            rows += closed.spherical_rows()
        elif row == "screw":
            turn = [multiply(closed.geometry.parameters[0], x) for x in closed.angle_row()]
            rows.append(sum_of([closed.dot2_row(axes_i["h"]), opposite(turn)]))
        elif row.endswith("d"):
            rows.append(closed.dot2_row(axes_i[row[0]]))
        else:
            rows.append(closed.dot1_row(axes_i[row[0]], axes_j[row[2]]))
    return rows


def second(joint: str, closed: Closed, multipliers: Vector, lambda_first: bool) -> Matrix:
    """(phi_q^T lambda)_q [12 x 12]."""
    axes_i, axes_j = closed.geometry.axes_i, closed.geometry.axes_j
    terms: list[Blocks] = []
    axes: dict[str, list[Vector]] = {}
    places = iter(multipliers)
    for row in ROWS[joint]:
        if row == "d":
            terms.append(closed.spherical_second([next(places) for _ in range(3)]))
            continue
        multiplier = next(places)
        if row == "screw":
            terms.append(_scaled(multiply(-1, closed.geometry.parameters[0] * multiplier), closed.angle_second()))
            row = "h.d"
        along = axes_i[row[0]]
        if lambda_first:
            axes.setdefault(row[2], []).append([multiplier * x for x in along])
        else:
            blocks = closed.dot2_second(along) if row[2] == "d" else closed.dot1_second(along, axes_j[row[2]])
            terms.append(_scaled(multiplier, blocks))
    for other, vectors in axes.items():
        total = sum_of(vectors)
        terms.append(closed.dot2_second(total) if other == "d" else closed.dot1_second(total, axes_j[other]))
    return _assembled(terms)


def _scaled(factor: Scalar, blocks: Blocks) -> Blocks:
    return {place: scaled(factor, block) for place, block in blocks.items()}


def _assembled(terms: list[Blocks]) -> Matrix:
    dense = zeros(12, 12)
    for blocks in terms:
        for (m, n), block in blocks.items():
            for row in range(3):
                for column in range(3):
                    place = dense[3 * m + row]
                    place[3 * n + column] = add(place[3 * n + column], block[row][column])
    return dense
