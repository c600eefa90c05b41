// Pinocchio in C++, its algorithms on a model in memory.
#include "pinocchio_model.hpp"

#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/regressor.hpp>
#include <pinocchio/algorithm/rnea.hpp>

#include "peer.h"

namespace {
pinocchio::Model model;
pinocchio::Data data;
using In = Eigen::Map<const Eigen::VectorXd>;

In map(const double *x)
{
    return In(x, model.nv);
}

const double *inverse_dynamics(const double *q, const double *dq, const double *ddq)
{
    return pinocchio::rnea(model, data, map(q), map(dq), map(ddq)).data();
}

const double *mass_matrix(const double *q, const double *, const double *)
{
    return pinocchio::crba(model, data, map(q), pinocchio::Convention::LOCAL).data();
}

const double *mass_matrix_world(const double *q, const double *, const double *)
{
    return pinocchio::crba(model, data, map(q), pinocchio::Convention::WORLD).data();
}

const double *forward_dynamics(const double *q, const double *dq, const double *effort)
{
    return pinocchio::aba(model, data, map(q), map(dq), map(effort), pinocchio::Convention::LOCAL).data();
}

const double *forward_dynamics_world(const double *q, const double *dq, const double *effort)
{
    return pinocchio::aba(model, data, map(q), map(dq), map(effort), pinocchio::Convention::WORLD).data();
}

const double *regressor(const double *q, const double *dq, const double *ddq)
{
    return pinocchio::computeJointTorqueRegressor(model, data, map(q), map(dq), map(ddq)).data();
}
} // namespace

const peer_function *peer_open(const char *path)
{
    model = read_model(path);
    data = pinocchio::Data(model);
    const int n = model.nv;
    static peer_function functions[] = {{"inverse_dynamics", n, inverse_dynamics},
                                        {"mass_matrix", n * n, mass_matrix},
                                        {"mass_matrix_world", n * n, mass_matrix_world},
                                        {"forward_dynamics", n, forward_dynamics},
                                        {"forward_dynamics_world", n, forward_dynamics_world},
                                        {"regressor", 10 * n * n, regressor},
                                        {nullptr, 0, nullptr}};
    return functions;
}
