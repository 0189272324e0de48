// D and C of a platform with Eigen: by QR and SVD in both orders, and by Gram matrices.
#include <Eigen/Dense>

using Matrix63 = Eigen::Matrix<double, 6, 3>;
using Matrix66 = Eigen::Matrix<double, 6, 6>;
using Points = Eigen::Matrix<double, 3, 6>;

static Matrix66 jacobian(const Points &base, const Points &joints, const double *o, const double *R)
{
    const Eigen::Map<const Eigen::Vector3d> origin(o);
    const Eigen::Map<const Eigen::Matrix3d> turn(R);
    Matrix66 J;
    for (int i = 0; i < 6; ++i) {
        const Eigen::Vector3d p = turn * joints.col(i);
        const Eigen::Vector3d e = (p + (origin - base.col(i))).normalized();
        J.row(i) << e.transpose(), p.cross(e).transpose();
    }
    return J;
}

static void told(const Eigen::Vector3d &values, double *D, double *C)
{
    *D = values.prod();
    *C = values(0) / values(2);
}

static void pair_of(const Matrix66 &A, double *D_first, double *C_first, double *D_last, double *C_last)
{
    const Eigen::HouseholderQR<Matrix66> factor(A);
    const Matrix66 R = factor.matrixQR().triangularView<Eigen::Upper>();
    const Eigen::JacobiSVD<Eigen::Matrix3d> first(R.topLeftCorner<3, 3>());
    const Eigen::JacobiSVD<Eigen::Matrix3d> last(R.bottomRightCorner<3, 3>());
    told(first.singularValues(), D_first, C_first);
    told(last.singularValues(), D_last, C_last);
}

extern "C" void eigen_qr_svd(long count, const double *base, const double *joints, const double *o, const double *R, double *D, double *C)
{
    const Points B = Eigen::Map<const Points>(base), P = Eigen::Map<const Points>(joints);
    for (long k = 0; k < count; ++k) {
        const Matrix66 J = jacobian(B, P, o + 3 * k, R + 9 * k);
        Matrix66 other;
        other << J.rightCols<3>(), J.leftCols<3>();
        double *d = D + 4 * k, *c = C + 4 * k;
        pair_of(other, d + 3, c + 3, d, c);
        pair_of(J, d + 1, c + 1, d + 2, c + 2);
    }
}

static void of_gram(const Eigen::Matrix3d &N, double *D, double *C)
{
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(N, Eigen::EigenvaluesOnly);
    told(solver.eigenvalues().reverse().cwiseMax(0).cwiseSqrt(), D, C);
}

extern "C" void eigen_gram(long count, const double *base, const double *joints, const double *o, const double *R, double *D, double *C)
{
    const Points B = Eigen::Map<const Points>(base), P = Eigen::Map<const Points>(joints);
    for (long k = 0; k < count; ++k) {
        const Matrix66 J = jacobian(B, P, o + 3 * k, R + 9 * k);
        const Matrix63 J1 = J.leftCols<3>(), J2 = J.rightCols<3>();
        const Eigen::Matrix3d a = J1.transpose() * J1, b = J2.transpose() * J2, m = J1.transpose() * J2;
        double *d = D + 4 * k, *c = C + 4 * k;
        of_gram(a - m * b.inverse() * m.transpose(), d, c);
        of_gram(a, d + 1, c + 1);
        of_gram(b - m.transpose() * a.inverse() * m, d + 2, c + 2);
        of_gram(b, d + 3, c + 3);
    }
}
