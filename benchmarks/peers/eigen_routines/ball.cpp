// Ball joint: d_ij.
#include "blocks.hpp"

using namespace peers;

extern "C" void ROUTINE(const double *__restrict r_i, const double *__restrict A_i, const double *__restrict r_j,
                          const double *__restrict A_j, const double *__restrict geometry,
                          const double *__restrict lambda, double *__restrict phi, double *__restrict phi_q,
                          double *__restrict phi_q_t_lambda_q)
{
    const Joint joint(r_i, A_i, r_j, A_j, geometry);
    const Eigen::Map<const Vector3> force(lambda);
    Block<3, 1>{phi} = joint.d_ij();

    RowBlock<3>(phi_q).setConstant(-1.0);
    Block<3, 3>{phi_q + 3} = times_skew(joint.A_i, joint.s_i);
    RowBlock<3>(phi_q + 12).setConstant(1.0);
    Block<3, 3>{phi_q + 15} = -times_skew(joint.A_j, joint.s_j);

    const Vector3 force_i = joint.A_i.transpose() * force;
    const Vector3 force_j = joint.A_j.transpose() * force;
    Block<3, 3>{phi_q_t_lambda_q} = -skew_skew(joint.s_i, force_i);
    Block<3, 3>{phi_q_t_lambda_q + 9} = skew_skew(joint.s_j, force_j);
}
