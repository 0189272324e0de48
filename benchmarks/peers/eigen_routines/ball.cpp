// Ball joint: d_ij.
#include "blocks.hpp"

using namespace peers;

extern "C" INLINED void ROUTINE(const double *__restrict r_i, const double *__restrict A_i, const double *__restrict r_j,
                                const double *__restrict A_j, const double *__restrict geometry,
                                const double *__restrict lambda, double *__restrict phi, double *__restrict phi_q,
                                double *__restrict phi_q_t_lambda_q)
{
    const Joint joint(r_i, A_i, r_j, A_j, geometry);
    const Eigen::Map<const Vector3> force(lambda);
    Block<3, 1>{phi} = joint.d_ij();

    RowBlock<3>(phi_q).setConstant(-1.0);
    set_times_skew(joint.A_i, joint.s_i, Block<3, 3>(phi_q + 3));
    RowBlock<3>(phi_q + 12).setConstant(1.0);
    set_times_skew(joint.A_j, Vector3(-joint.s_j), Block<3, 3>(phi_q + 15));

    const Vector3 force_i = joint.A_i.transpose() * force;
    const Vector3 force_j = joint.A_j.transpose() * force;
    set_less_diagonal(Block<3, 3>(phi_q_t_lambda_q), -outer(force_i, joint.s_i), -joint.s_i.dot(force_i));
    set_less_diagonal(Block<3, 3>(phi_q_t_lambda_q + 9), outer(force_j, joint.s_j), joint.s_j.dot(force_j));
}
