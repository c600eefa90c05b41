// Derivatives by Pinocchio in C++. A function's result is the first matrix that it fills; the others have a
// name of their own, for the comparison.
#include "pinocchio_model.hpp"

#include <pinocchio/algorithm/aba-derivatives.hpp>
#include <pinocchio/algorithm/rnea-derivatives.hpp>

#include "peer.h"

namespace {
pinocchio::Model model;
pinocchio::Data data;
using In = Eigen::Map<const Eigen::VectorXd>;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
Rows copied;

In map(const double *x)
{
    return In(x, model.nv);
}

template <typename Matrix> const double *rows(const Matrix &matrix)
{
    copied = matrix;
    return copied.data();
}

const double *inverse_dynamics(const double *q, const double *dq, const double *ddq)
{
    pinocchio::computeRNEADerivatives(model, data, map(q), map(dq), map(ddq));
    return data.tau.data();
}

const double *inverse_dynamics_by_q(const double *q, const double *dq, const double *ddq)
{
    inverse_dynamics(q, dq, ddq);
    return rows(data.dtau_dq);
}

const double *inverse_dynamics_by_dq(const double *q, const double *dq, const double *ddq)
{
    inverse_dynamics(q, dq, ddq);
    return rows(data.dtau_dv);
}

const double *forward_dynamics(const double *q, const double *dq, const double *effort)
{
    pinocchio::computeABADerivatives(model, data, map(q), map(dq), map(effort));
    return data.ddq.data();
}

const double *forward_dynamics_by_q(const double *q, const double *dq, const double *effort)
{
    forward_dynamics(q, dq, effort);
    return rows(data.ddq_dq);
}

const double *forward_dynamics_by_dq(const double *q, const double *dq, const double *effort)
{
    forward_dynamics(q, dq, effort);
    return rows(data.ddq_dv);
}
} // namespace

const peer_function *peer_open(const char *path)
{
    model = read_model(path);
    data = pinocchio::Data(model);
    const int n = model.nv;
    static peer_function functions[] = {{"inverse_dynamics_derivatives", n, inverse_dynamics},
                                        {"inverse_dynamics_derivatives_by_q", n * n, inverse_dynamics_by_q},
                                        {"inverse_dynamics_derivatives_by_dq", n * n, inverse_dynamics_by_dq},
                                        {"forward_dynamics_derivatives", n, forward_dynamics},
                                        {"forward_dynamics_derivatives_by_q", n * n, forward_dynamics_by_q},
                                        {"forward_dynamics_derivatives_by_dq", n * n, forward_dynamics_by_dq},
                                        {nullptr, 0, nullptr}};
    return functions;
}
