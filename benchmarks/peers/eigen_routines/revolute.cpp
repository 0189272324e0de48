// Revolute joint: d_ij; f_i . h_j, g_i . h_j.
#include "blocks.hpp"

using namespace peers;

extern "C" INLINED void ROUTINE(const double *__restrict r_i, const double *__restrict A_i, const double *__restrict r_j,
                                const double *__restrict A_j, const double *__restrict geometry,
                                const double *__restrict lambda, double *__restrict phi, double *__restrict phi_q,
                                double *__restrict phi_q_t_lambda_q)
{
    const Joint joint(r_i, A_i, r_j, A_j, geometry);
    const Eigen::Map<const Vector3> force(lambda);
    const Matrix3 A_ij = joint.A_i.transpose() * joint.A_j;
    const Vector3 h = A_ij * joint.h_j();
    const Vector3 f_in_j = A_ij.transpose() * joint.f_i();
    const Vector3 g_in_j = A_ij.transpose() * joint.g_i();

    Block<3, 1>{phi} = joint.d_ij();
    phi[3] = joint.f_i().dot(h);
    phi[4] = joint.g_i().dot(h);

    RowBlock<3>(phi_q).setConstant(-1.0);
    Block<5, 3> on_i(phi_q + 3), on_j(phi_q + 21);
    set_times_skew(joint.A_i, joint.s_i, on_i.topRows<3>());
    on_i.row(3) = joint.f_i().cross(h);
    on_i.row(4) = joint.g_i().cross(h);
    RowBlock<3>(phi_q + 18).setConstant(1.0);
    set_times_skew(joint.A_j, Vector3(-joint.s_j), on_j.topRows<3>());
    on_j.row(3) = joint.h_j().cross(f_in_j);
    on_j.row(4) = joint.h_j().cross(g_in_j);

    const Vector3 a = lambda[3] * joint.f_i() + lambda[4] * joint.g_i();
    const Vector3 w = lambda[3] * f_in_j + lambda[4] * g_in_j;
    const Vector3 force_i = joint.A_i.transpose() * force;
    const Vector3 force_j = joint.A_j.transpose() * force;
    const double a_h = a.dot(h);
    store(outer(h, a) - outer(force_i, joint.s_i), a_h - joint.s_i.dot(force_i), a_h * A_ij - outer(h, w),
          outer(w, joint.h_j()) + outer(force_j, joint.s_j), a_h + joint.s_j.dot(force_j), phi_q_t_lambda_q);
}
