// Basic constraints with Eigen, written by hand: vectors first, outer products for products of skew matrices, and
// multipliers added up before they enter a block. A column of the Jacobian that belongs to a rotation of body i is in
// the axes of body i, likewise j; A_ij = A_i^T A_j.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace peers {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
template <int Rows, int Columns> using Block = Eigen::Map<Eigen::Matrix<double, Rows, Columns>>;
template <int Columns> using RowBlock = Eigen::Map<Eigen::Matrix<double, 1, Columns>>;

struct Joint {
    Eigen::Map<const Vector3> r_i;
    Eigen::Map<const Matrix3> A_i;
    Eigen::Map<const Vector3> r_j;
    Eigen::Map<const Matrix3> A_j;
    Eigen::Map<const Vector3> s_i;
    Eigen::Map<const Matrix3> C_i;
    Eigen::Map<const Vector3> s_j;
    Eigen::Map<const Matrix3> C_j;

    Joint(const double *r_i_, const double *A_i_, const double *r_j_, const double *A_j_, const double *geometry)
        : r_i(r_i_), A_i(A_i_), r_j(r_j_), A_j(A_j_), s_i(geometry), C_i(geometry + 3), s_j(geometry + 12),
          C_j(geometry + 15)
    {
    }

    auto f_i() const { return C_i.col(0); }
    auto g_i() const { return C_i.col(1); }
    auto h_i() const { return C_i.col(2); }
    auto f_j() const { return C_j.col(0); }
    auto g_j() const { return C_j.col(1); }
    auto h_j() const { return C_j.col(2); }
    Vector3 d_ij() const { return r_j + A_j * s_j - r_i - A_i * s_i; }
};

// A a~
template <class Matrix, class Vector> inline Matrix3 times_skew(const Matrix &A, const Vector &a)
{
    Matrix3 product;
    product.col(0) = A.col(1) * a.z() - A.col(2) * a.y();
    product.col(1) = A.col(2) * a.x() - A.col(0) * a.z();
    product.col(2) = A.col(0) * a.y() - A.col(1) * a.x();
    return product;
}

// a~ b~ = b a^T - (a . b) I
template <class A, class B> inline Matrix3 skew_skew(const A &a, const B &b)
{
    Matrix3 product = b * a.transpose();
    product.diagonal().array() -= a.dot(b);
    return product;
}

// Blocks of the second derivative in the rotations of both bodies; (pi_j, pi_i) is the transpose of (pi_i, pi_j).
struct Rotations {
    Matrix3 ii, ij, jj;
};

// a_i . b_j; v = A_ij b, w = A_ij^T a
template <class A, class B>
inline Rotations dot1_second(const A &a, const B &b, const Vector3 &v, const Vector3 &w, const Matrix3 &A_ij)
{
    const double a_v = a.dot(v);
    Rotations blocks;
    blocks.ii = v * a.transpose();
    blocks.ii.diagonal().array() -= a_v;
    blocks.ij = a_v * A_ij - v * w.transpose();
    blocks.jj = w * b.transpose();
    blocks.jj.diagonal().array() -= a_v;
    return blocks;
}

// a_i . d_ij; e = A_i^T d_ij + s_i, u = A_ij s_j, w = A_ij^T a
template <class A, class S>
inline Rotations dot2_second(const A &a, const S &s_j, const Vector3 &e, const Vector3 &u, const Vector3 &w,
                             const Matrix3 &A_ij)
{
    Rotations blocks;
    blocks.ii = skew_skew(a, e);
    blocks.ij = a.dot(u) * A_ij - u * w.transpose();
    blocks.jj = skew_skew(s_j, w);
    return blocks;
}

inline Rotations operator+(const Rotations &a, const Rotations &b)
{
    return {a.ii + b.ii, a.ij + b.ij, a.jj + b.jj};
}

// Stored entries of a second derivative that has rotations only: columns pi_i, then pi_j.
inline void store(const Rotations &blocks, double *values)
{
    Block<6, 3> on_i(values), on_j(values + 18);
    on_i.topRows<3>() = blocks.ii;
    on_i.bottomRows<3>() = blocks.ij.transpose();
    on_j.topRows<3>() = blocks.ij;
    on_j.bottomRows<3>() = blocks.jj;
}

// Stored entries of a second derivative with dot-2 constraints: columns r_i, pi_i, r_j, pi_j; moved = A_i a~.
inline void store(const Rotations &blocks, const Matrix3 &moved, double *values)
{
    Block<3, 3>{values} = moved.transpose();
    Block<12, 3> on_i(values + 9);
    on_i.topRows<3>() = moved;
    on_i.middleRows<3>(3) = blocks.ii;
    on_i.middleRows<3>(6) = -moved;
    on_i.bottomRows<3>() = blocks.ij.transpose();
    Block<3, 3>{values + 45} = -moved.transpose();
    Block<6, 3> on_j(values + 54);
    on_j.topRows<3>() = blocks.ij;
    on_j.bottomRows<3>() = blocks.jj;
}

} // namespace peers
