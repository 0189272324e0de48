// The same six quantities by Pinocchio, from a model of the tree with operational frames for C and R.
//
//     pinocchio TABLE          times them
//     pinocchio TABLE once     evaluates them once and prints them
//
// TABLE: numbers of links and cuts, gravity, q, qd, then for each frame parent, type, rotation, offset, mass, centre, inertia.
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/frames.hpp>
#include <pinocchio/algorithm/jacobian.hpp>
#include <pinocchio/algorithm/kinematics.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include <pinocchio/multibody.hpp>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>

namespace pin = pinocchio;

static const int ROUNDS = 301;
static const double BLOCK_NANOSECONDS = 1e5;

static int links, cuts;
static pin::Model model;
static pin::Data data;
static pin::FrameIndex first;
static Eigen::VectorXd q, qd, still, phi, gamma_R, f_C, f_G;
static Eigen::MatrixXd J;
static pin::Data::Matrix6x J_C, J_R;

template <typename Values> static void take(std::ifstream &table, Values &values)
{
    for (int i = 0; i < values.rows(); ++i) {
        for (int k = 0; k < values.cols(); ++k) {
            table >> values(i, k);
        }
    }
}

static void take_frame(std::ifstream &table, int number)
{
    int parent, type;
    Eigen::Matrix3d R, I;
    Eigen::Vector3d p, centre;
    double mass;
    table >> parent >> type;
    take(table, R);
    take(table, p);
    table >> mass;
    take(table, centre);
    take(table, I);
    const pin::SE3 placement(R, p);
    const auto carrier = static_cast<pin::JointIndex>(parent + 1);
    const std::string name = "frame" + std::to_string(number);
    if (type == 2) {
        model.addFrame(pin::Frame(name, carrier, 0, placement, pin::OP_FRAME));
        return;
    }
    const auto joint = type == 1 ? model.addJoint(carrier, pin::JointModelPZ(), placement, name)
                                 : model.addJoint(carrier, pin::JointModelRZ(), placement, name);
    model.appendBodyToJoint(joint, pin::Inertia(mass, centre, I));
}

static void make(const char *file)
{
    std::ifstream table(file);
    table >> links >> cuts;
    Eigen::Vector3d gravity;
    take(table, gravity);
    model.gravity.linear() = gravity;
    q.resize(links);
    qd.resize(links);
    take(table, q);
    take(table, qd);
    for (int k = 0; k < links + 2 * cuts; ++k) {
        take_frame(table, k);
    }
    data = pin::Data(model);
    first = model.frames.size() - static_cast<std::size_t>(2 * cuts);
    still = Eigen::VectorXd::Zero(links);
    phi.resize(6 * cuts);
    gamma_R.resize(6 * cuts);
    J.resize(6 * cuts, links);
    J_C.resize(6, links);
    J_R.resize(6, links);
}

extern "C" void task_0(void);

extern "C" void task_0(void)
{
    pin::forwardKinematics(model, data, q, qd, still);
    pin::computeJointJacobians(model, data);
    for (int cut = 0; cut < cuts; ++cut) {
        const auto C = first + static_cast<pin::FrameIndex>(cut), R = C + static_cast<pin::FrameIndex>(cuts);
        const pin::SE3 T = pin::updateFramePlacement(model, data, C).actInv(pin::updateFramePlacement(model, data, R));
        const double root = std::sqrt(1.0 + T.rotation().trace());
        phi.segment<3>(6 * cut) = T.translation();
        phi[6 * cut + 3] = (T.rotation()(2, 1) - T.rotation()(1, 2)) / root;
        phi[6 * cut + 4] = (T.rotation()(0, 2) - T.rotation()(2, 0)) / root;
        phi[6 * cut + 5] = (T.rotation()(1, 0) - T.rotation()(0, 1)) / root;
        J_C.setZero();
        J_R.setZero();
        pin::getFrameJacobian(model, data, C, pin::LOCAL, J_C);
        pin::getFrameJacobian(model, data, R, pin::LOCAL, J_R);
        J.middleRows<6>(6 * cut) = J_R - J_C;
        const auto a_C = pin::getFrameClassicalAcceleration(model, data, C, pin::LOCAL);
        const auto a_R = pin::getFrameClassicalAcceleration(model, data, R, pin::LOCAL);
        gamma_R.segment<6>(6 * cut) = (a_R - a_C).toVector();
    }
    f_G = -pin::computeGeneralizedGravity(model, data, q);
    f_C = pin::nonLinearEffects(model, data, q, qd) + f_G;
    pin::crba(model, data, q);
    data.M.triangularView<Eigen::StrictlyLower>() = data.M.transpose().triangularView<Eigen::StrictlyLower>();
}

static double nanoseconds(long repetitions)
{
    const auto start = std::chrono::steady_clock::now();
    for (long k = 0; k < repetitions; ++k) {
        task_0();
    }
    const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - start;
    return taken.count() / static_cast<double>(repetitions);
}

template <typename Values> static void print(const char *name, const Values &values, const char *end)
{
    std::printf("\"%s\": [", name);
    for (int i = 0; i < values.rows(); ++i) {
        for (int k = 0; k < values.cols(); ++k) {
            std::printf("%s%.17g", i + k ? ", " : "", values(i, k));
        }
    }
    std::printf("]%s", end);
}

int main(int arguments, char **argument)
{
    make(argument[1]);
    if (arguments > 2) {
        task_0();
        std::printf("{");
        print("phi", phi, ", ");
        print("J", J, ", ");
        print("gamma_R", gamma_R, ", ");
        print("M", data.M, ", ");
        print("f_C", f_C, ", ");
        print("f_G", f_G, "}\n");
        return 0;
    }
    long repetitions = 1;
    while (nanoseconds(repetitions) * static_cast<double>(repetitions) < BLOCK_NANOSECONDS) {
        repetitions *= 2;
    }
    std::printf("[");
    for (int round = 0; round < ROUNDS; ++round) {
        std::printf("%s[%.9g]", round ? ", " : "", nanoseconds(repetitions));
    }
    std::printf("]\n");
    return 0;
}
