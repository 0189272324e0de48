// Screw joint: f_i . d_ij, g_i . d_ij; f_i . h_j, g_i . h_j; h_i . d_ij - p (theta + 2 pi n + theta_0).
#include "blocks.hpp"

using namespace peers;

extern "C" INLINED void ROUTINE(const double *__restrict r_i, const double *__restrict A_i, const double *__restrict r_j,
                                const double *__restrict A_j, const double *__restrict geometry,
                                const double *__restrict lambda, double *__restrict phi, double *__restrict phi_q,
                                double *__restrict phi_q_t_lambda_q)
{
    const Joint joint(r_i, A_i, r_j, A_j, geometry);
    const double pitch = geometry[24], initial = geometry[25], revolutions = geometry[26];
    const Matrix3 A_ij = joint.A_i.transpose() * joint.A_j;
    const Vector3 f = A_ij * joint.f_j();
    const Vector3 h = A_ij * joint.h_j();
    const Vector3 u = A_ij * joint.s_j;
    const Matrix3 in_j = A_ij.transpose() * joint.C_i;
    const Vector3 d = joint.A_i.transpose() * joint.d_ij();
    const Vector3 e = d + joint.s_i;

    // theta = atan2(y, x); theta_q = (x y_q - y x_q) / (x^2 + y^2) is the row of n . f_j with n = (x g - y f) / (x^2 + y^2)
    const double x = joint.f_i().dot(f), y = joint.g_i().dot(f);
    const double inverse = 1.0 / (x * x + y * y), along = x * inverse, across = y * inverse;
    const Vector3 n = along * joint.g_i() - across * joint.f_i();
    const Vector3 n_in_j = along * in_j.col(1) - across * in_j.col(0);
    const Vector3 m = along * joint.f_i() + across * joint.g_i();
    const Vector3 m_in_j = along * in_j.col(0) + across * in_j.col(1);
    const Vector3 theta_i = n.cross(f), theta_j = joint.f_j().cross(n_in_j);
    const Vector3 sigma_i = m.cross(f), sigma_j = joint.f_j().cross(m_in_j);

    phi[0] = joint.f_i().dot(d);
    phi[1] = joint.g_i().dot(d);
    phi[2] = joint.f_i().dot(h);
    phi[3] = joint.g_i().dot(h);
    phi[4] = joint.h_i().dot(d) - pitch * (std::atan2(y, x) + 6.283185307179586 * revolutions + initial);

    const Matrix3 world = (joint.A_i * joint.C_i).transpose();
    Block<3, 3>{phi_q} = -world;
    Block<5, 3> on_i(phi_q + 9), on_j(phi_q + 33);
    on_i.row(0) = joint.f_i().cross(e);
    on_i.row(1) = joint.g_i().cross(e);
    on_i.row(2) = joint.f_i().cross(h);
    on_i.row(3) = joint.g_i().cross(h);
    on_i.row(4) = joint.h_i().cross(e) - pitch * theta_i;
    Block<3, 3>{phi_q + 24} = world;
    on_j.row(0) = joint.s_j.cross(in_j.col(0));
    on_j.row(1) = joint.s_j.cross(in_j.col(1));
    on_j.row(2) = joint.h_j().cross(in_j.col(0));
    on_j.row(3) = joint.h_j().cross(in_j.col(1));
    on_j.row(4) = joint.s_j.cross(in_j.col(2)) - pitch * theta_j;

    // d(theta_q^T)/dq = second derivative of n . f_j with n fixed, less theta_q sigma^T + sigma theta_q^T
    const double torque = -pitch * lambda[4];
    const Vector3 a_d = lambda[0] * joint.f_i() + lambda[1] * joint.g_i() + lambda[4] * joint.h_i();
    const Vector3 w_d = lambda[0] * in_j.col(0) + lambda[1] * in_j.col(1) + lambda[4] * in_j.col(2);
    const Vector3 a_h = lambda[2] * joint.f_i() + lambda[3] * joint.g_i();
    const Vector3 w_h = lambda[2] * in_j.col(0) + lambda[3] * in_j.col(1);
    const Vector3 a_f = torque * n;
    const Vector3 w_f = torque * n_in_j;
    const Vector3 torque_i = torque * sigma_i, torque_j = torque * sigma_j;
    const double along_h = a_h.dot(h), along_f = a_f.dot(f), along_u = a_d.dot(u);
    store(joint.A_i, a_d,
          outer(h, a_h) + outer(f, a_f) + outer(e, a_d) - outer(theta_i, torque_i) - outer(torque_i, theta_i),
          along_h + along_f + a_d.dot(e),
          (along_h + along_f + along_u) * A_ij - outer(h, w_h) - outer(f, w_f) - outer(u, w_d) - outer(theta_i, torque_j) -
              outer(torque_i, theta_j),
          outer(w_h, joint.h_j()) + outer(w_f, joint.f_j()) + outer(w_d, joint.s_j) - outer(theta_j, torque_j) -
              outer(torque_j, theta_j),
          along_h + along_f + along_u, phi_q_t_lambda_q);
}
