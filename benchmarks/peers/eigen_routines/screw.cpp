// Screw joint: f_i . d_ij, g_i . d_ij; f_i . h_j, g_i . h_j; h_i . d_ij - p (theta + 2 pi n + theta_0).
#include "blocks.hpp"

using namespace peers;

extern "C" void ROUTINE(const double *__restrict r_i, const double *__restrict A_i, const double *__restrict r_j,
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
    const double along = x / (x * x + y * y), across = y / (x * x + y * y);
    const Vector3 n = along * joint.g_i() - across * joint.f_i();
    const Vector3 n_in_j = along * in_j.col(1) - across * in_j.col(0);
    const Vector3 m = along * joint.f_i() + across * joint.g_i();
    const Vector3 m_in_j = along * in_j.col(0) + across * in_j.col(1);
    Eigen::Matrix<double, 6, 1> theta_q, sigma;
    theta_q << n.cross(f), joint.f_j().cross(n_in_j);
    sigma << m.cross(f), joint.f_j().cross(m_in_j);

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
    on_i.row(4) = joint.h_i().cross(e) - pitch * theta_q.head<3>();
    Block<3, 3>{phi_q + 24} = world;
    on_j.row(0) = joint.s_j.cross(in_j.col(0));
    on_j.row(1) = joint.s_j.cross(in_j.col(1));
    on_j.row(2) = joint.h_j().cross(in_j.col(0));
    on_j.row(3) = joint.h_j().cross(in_j.col(1));
    on_j.row(4) = joint.s_j.cross(in_j.col(2)) - pitch * theta_q.tail<3>();

    // d(theta_q^T)/dq = second derivative of n . f_j with n fixed, less theta_q sigma^T + sigma theta_q^T
    const double torque = -pitch * lambda[4];
    const Vector3 a_d = lambda[0] * joint.f_i() + lambda[1] * joint.g_i() + lambda[4] * joint.h_i();
    const Vector3 w_d = lambda[0] * in_j.col(0) + lambda[1] * in_j.col(1) + lambda[4] * in_j.col(2);
    const Vector3 a_h = lambda[2] * joint.f_i() + lambda[3] * joint.g_i();
    const Vector3 w_h = lambda[2] * in_j.col(0) + lambda[3] * in_j.col(1);
    const Vector3 a_f = torque * n;
    const Vector3 w_f = torque * n_in_j;
    Rotations blocks = dot1_second(a_h, joint.h_j(), h, w_h, A_ij) + dot1_second(a_f, joint.f_j(), f, w_f, A_ij) +
                       dot2_second(a_d, joint.s_j, e, u, w_d, A_ij);
    const Vector3 s_i = torque * sigma.head<3>(), s_j = torque * sigma.tail<3>();
    const Vector3 t_i = theta_q.head<3>(), t_j = theta_q.tail<3>();
    blocks.ii -= t_i * s_i.transpose() + s_i * t_i.transpose();
    blocks.ij -= t_i * s_j.transpose() + s_i * t_j.transpose();
    blocks.jj -= t_j * s_j.transpose() + s_j * t_j.transpose();
    store(blocks, times_skew(joint.A_i, a_d), phi_q_t_lambda_q);
}
