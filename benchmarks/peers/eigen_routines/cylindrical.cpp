// Cylindrical joint: f_i . d_ij, g_i . d_ij; f_i . h_j, g_i . h_j.
#include "blocks.hpp"

using namespace peers;

extern "C" INLINED void ROUTINE(const double *__restrict r_i, const double *__restrict A_i, const double *__restrict r_j,
                                const double *__restrict A_j, const double *__restrict geometry,
                                const double *__restrict lambda, double *__restrict phi, double *__restrict phi_q,
                                double *__restrict phi_q_t_lambda_q)
{
    const Joint joint(r_i, A_i, r_j, A_j, geometry);
    const Matrix3 A_ij = joint.A_i.transpose() * joint.A_j;
    const Vector3 h = A_ij * joint.h_j();
    const Vector3 u = A_ij * joint.s_j;
    const Vector3 f_in_j = A_ij.transpose() * joint.f_i();
    const Vector3 g_in_j = A_ij.transpose() * joint.g_i();
    const Vector3 d = joint.A_i.transpose() * joint.d_ij();
    const Vector3 e = d + joint.s_i;

    phi[0] = joint.f_i().dot(d);
    phi[1] = joint.g_i().dot(d);
    phi[2] = joint.f_i().dot(h);
    phi[3] = joint.g_i().dot(h);

    const Eigen::Matrix<double, 2, 3> world = (joint.A_i * joint.C_i.leftCols<2>()).transpose();
    Block<2, 3>{phi_q} = -world;
    Block<4, 3> on_i(phi_q + 6), on_j(phi_q + 24);
    on_i.row(0) = joint.f_i().cross(e);
    on_i.row(1) = joint.g_i().cross(e);
    on_i.row(2) = joint.f_i().cross(h);
    on_i.row(3) = joint.g_i().cross(h);
    Block<2, 3>{phi_q + 18} = world;
    on_j.row(0) = joint.s_j.cross(f_in_j);
    on_j.row(1) = joint.s_j.cross(g_in_j);
    on_j.row(2) = joint.h_j().cross(f_in_j);
    on_j.row(3) = joint.h_j().cross(g_in_j);

    const Vector3 a_d = lambda[0] * joint.f_i() + lambda[1] * joint.g_i();
    const Vector3 w_d = lambda[0] * f_in_j + lambda[1] * g_in_j;
    const Vector3 a_h = lambda[2] * joint.f_i() + lambda[3] * joint.g_i();
    const Vector3 w_h = lambda[2] * f_in_j + lambda[3] * g_in_j;
    const double along_h = a_h.dot(h), along_u = a_d.dot(u);
    store(joint.A_i, a_d, outer(h, a_h) + outer(e, a_d), along_h + a_d.dot(e),
          (along_h + along_u) * A_ij - outer(h, w_h) - outer(u, w_d), outer(w_h, joint.h_j()) + outer(w_d, joint.s_j),
          along_h + along_u, phi_q_t_lambda_q);
}
