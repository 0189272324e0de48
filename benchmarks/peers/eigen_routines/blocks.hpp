// Basic constraints with Eigen, written by hand: vectors first, outer products for products of skew matrices,
// multipliers added up before they enter a block, blocks evaluated where they are stored. A column of the Jacobian that belongs to a rotation of body i is in
// the axes of body i, likewise j; A_ij = A_i^T A_j.
#pragma once

// INLINED and EIGEN_UNROLLING_LIMIT: Eigen's default leaves loops in sums of a few outer products, and the compilers
// then do not inline them. The routines are compiled as they are, and with both remedies.
#ifndef INLINED
#define INLINED
#endif

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

// target = A a~
template <class Matrix, class Vector, class Target>
inline void set_times_skew(const Matrix &A, const Vector &a, Target &&target)
{
    target.col(0) = A.col(1) * a.z() - A.col(2) * a.y();
    target.col(1) = A.col(2) * a.x() - A.col(0) * a.z();
    target.col(2) = A.col(0) * a.y() - A.col(1) * a.x();
}

// a b^T, evaluated where it is stored. Products of skew matrices are such: a~ b~ = b a^T - (a . b) I.
template <class A, class B> inline auto outer(const A &a, const B &b) { return a.lazyProduct(b.transpose()); }

template <class Target, class Expression>
inline void set_less_diagonal(Target &&target, const Expression &full, double diagonal)
{
    target = full;
    target.diagonal().array() -= diagonal;
}

// Stored entries of a second derivative that has rotations only, columns pi_i, then pi_j:
// [ii - d_i I, ij; ij^T, jj - d_j I].
template <class II, class IJ, class JJ>
inline void store(const II &ii, double d_i, const IJ &ij, const JJ &jj, double d_j, double *values)
{
    Block<6, 3> on_i(values), on_j(values + 18);
    set_less_diagonal(on_i.topRows<3>(), ii, d_i);
    on_j.topRows<3>() = ij;
    on_i.bottomRows<3>() = on_j.topRows<3>().transpose();
    set_less_diagonal(on_j.bottomRows<3>(), jj, d_j);
}

// The same with dot-2 constraints, columns r_i, pi_i, r_j, pi_j; a is their axis, multiplied by lambda.
template <class A, class II, class IJ, class JJ>
inline void store(const A &A_i, const Vector3 &a, const II &ii, double d_i, const IJ &ij, const JJ &jj, double d_j,
                  double *values)
{
    Block<12, 3> on_i(values + 9);
    Block<6, 3> on_j(values + 54);
    set_times_skew(A_i, a, on_i.topRows<3>());
    Block<3, 3>{values} = on_i.topRows<3>().transpose();
    set_less_diagonal(on_i.middleRows<3>(3), ii, d_i);
    on_i.middleRows<3>(6) = -on_i.topRows<3>();
    Block<3, 3>{values + 45} = -on_i.topRows<3>().transpose();
    on_j.topRows<3>() = ij;
    on_i.bottomRows<3>() = on_j.topRows<3>().transpose();
    set_less_diagonal(on_j.bottomRows<3>(), jj, d_j);
}

} // namespace peers
