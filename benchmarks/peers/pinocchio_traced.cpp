// Pinocchio's algorithms traced with CasADi's symbols, as C: pinocchio_traced MODEL OUT.c NAMES. NAMES: functions,
// separated by commas.
#include <pinocchio/autodiff/casadi.hpp>

#include "pinocchio_model.hpp"

#include <pinocchio/algorithm/aba-derivatives.hpp>
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/regressor.hpp>
#include <pinocchio/algorithm/rnea-derivatives.hpp>
#include <pinocchio/algorithm/rnea.hpp>

using casadi::SX;

namespace {
using Model = pinocchio::ModelTpl<SX>;
using Vector = Model::ConfigVectorType;

Vector vector(const SX &symbols)
{
    Vector result(symbols.size1());
    pinocchio::casadi::copy(symbols, result);
    return result;
}

template <typename Matrix> SX symbols(const Matrix &matrix)
{
    SX result(matrix.rows(), matrix.cols());
    pinocchio::casadi::copy(matrix, result);
    return result;
}

// elements of a matrix, row after row
template <typename Matrix> SX rows(const Matrix &matrix)
{
    return vec(symbols(matrix).T());
}
} // namespace

int main(int argc, char **argv)
{
    if (argc != 4)
        return 2;
    const Model model = read_model(argv[1]).cast<SX>();
    pinocchio::DataTpl<SX> data(model);
    const int n = model.nv;
    const SX x = SX::sym("q", n), v = SX::sym("dq", n), a = SX::sym("third", n);
    const Vector q = vector(x), dq = vector(v), third = vector(a);
    const std::string names = std::string(",") + argv[3] + ",";
    // the file has the name of its first function, a prefix of what it defines besides
    casadi::CodeGenerator code("of_" + names.substr(1, names.find(',', 1) - 1), {{"with_header", false}});
    const auto wanted = [&](const std::string &name) { return names.find("," + name + ",") != std::string::npos; };
    const auto add = [&](const std::string &name, const SX &result) {
        if (!wanted(name))
            return;
        code.add(casadi::Function("traced_" + name, {x, v, a}, {densify(result)}, {{"cse", true}}));
    };
    pinocchio::rnea(model, data, q, dq, third);
    add("inverse_dynamics", symbols(data.tau));
    using pinocchio::Convention;
    for (const auto convention : {Convention::LOCAL, Convention::WORLD}) {
        const std::string suffix = convention == Convention::WORLD ? "_world" : "";
        data.M.fill(SX(0));
        pinocchio::crba(model, data, q, convention);
        data.M.triangularView<Eigen::StrictlyLower>() =
            data.M.transpose().triangularView<Eigen::StrictlyLower>();
        add("mass_matrix" + suffix, symbols(data.M));
        pinocchio::aba(model, data, q, dq, third, convention);
        add("forward_dynamics" + suffix, symbols(data.ddq));
    }
    if (wanted("regressor"))
        pinocchio::computeJointTorqueRegressor(model, data, q, dq, third);
    add("regressor", symbols(data.jointTorqueRegressor));
    if (wanted("inverse_dynamics_derivatives")) {
        pinocchio::computeRNEADerivatives(model, data, q, dq, third);
        data.M.triangularView<Eigen::StrictlyLower>() =
            data.M.transpose().triangularView<Eigen::StrictlyLower>();
        add("inverse_dynamics_derivatives",
            vertcat(symbols(data.tau), rows(data.dtau_dq), rows(data.dtau_dv), rows(data.M)));
    }
    if (wanted("forward_dynamics_derivatives")) {
        pinocchio::computeABADerivatives(model, data, q, dq, third);
        data.Minv.triangularView<Eigen::StrictlyLower>() =
            data.Minv.transpose().triangularView<Eigen::StrictlyLower>();
        add("forward_dynamics_derivatives",
            vertcat(symbols(data.ddq), rows(data.ddq_dq), rows(data.ddq_dv), rows(data.Minv)));
    }
    std::ofstream(argv[2]) << code.dump();
}
