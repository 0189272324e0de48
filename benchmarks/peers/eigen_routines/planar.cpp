// Planar joint: f_i . h_j, g_i . h_j; h_i . d_ij.
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
    const Matrix3 in_j = A_ij.transpose() * joint.C_i;
    const Vector3 d = joint.A_i.transpose() * joint.d_ij();
    const Vector3 e = d + joint.s_i;

    phi[0] = joint.f_i().dot(h);
    phi[1] = joint.g_i().dot(h);
    phi[2] = joint.h_i().dot(d);

    const Vector3 world = joint.A_i * joint.h_i();
    Block<3, 1>{phi_q} = -world;
    Block<3, 3> on_i(phi_q + 3), on_j(phi_q + 15);
    on_i.row(0) = joint.f_i().cross(h);
    on_i.row(1) = joint.g_i().cross(h);
    on_i.row(2) = joint.h_i().cross(e);
    Block<3, 1>{phi_q + 12} = world;
    on_j.row(0) = joint.h_j().cross(in_j.col(0));
    on_j.row(1) = joint.h_j().cross(in_j.col(1));
    on_j.row(2) = joint.s_j.cross(in_j.col(2));

    const Vector3 a_h = lambda[0] * joint.f_i() + lambda[1] * joint.g_i();
    const Vector3 w_h = lambda[0] * in_j.col(0) + lambda[1] * in_j.col(1);
    const Vector3 a_d = lambda[2] * joint.h_i();
    const Vector3 w_d = lambda[2] * in_j.col(2);
    const double along_h = a_h.dot(h), along_u = a_d.dot(u);
    store(joint.A_i, a_d, outer(h, a_h) + outer(e, a_d), along_h + a_d.dot(e),
          (along_h + along_u) * A_ij - outer(h, w_h) - outer(u, w_d), outer(w_h, joint.h_j()) + outer(w_d, joint.s_j),
          along_h + along_u, phi_q_t_lambda_q);
}
