// A model from a file of numbers: joints, gravity (3); then for each joint its parent (0: base), 1 for a prismatic
// one, its placement (3 x 4, by rows), mass, centre of mass (3), inertia about it (xx, xy, xz, yy, yz, zz).
#pragma once
#include <pinocchio/multibody.hpp>

#include <fstream>
#include <stdexcept>
#include <string>

inline pinocchio::Model read_model(const char *path)
{
    std::ifstream in(path);
    int count = 0;
    pinocchio::Model model;
    Eigen::Vector3d gravity;
    in >> count >> gravity[0] >> gravity[1] >> gravity[2];
    model.gravity.linear() = gravity;
    for (int i = 1; i <= count; i++) {
        std::size_t parent = 0;
        int prismatic = 0;
        Eigen::Matrix<double, 3, 4> place;
        double mass = 0;
        Eigen::Vector3d com;
        Eigen::Matrix<double, 6, 1> t;
        in >> parent >> prismatic;
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 4; c++)
                in >> place(r, c);
        in >> mass >> com[0] >> com[1] >> com[2];
        for (int k = 0; k < 6; k++)
            in >> t[k];
        Eigen::Matrix3d tensor;
        tensor << t[0], t[1], t[2], t[1], t[3], t[4], t[2], t[4], t[5];
        const pinocchio::SE3 se3(place.leftCols<3>(), place.col(3));
        const std::string name = "joint" + std::to_string(i);
        const auto id = prismatic ? model.addJoint(parent, pinocchio::JointModelPZ(), se3, name)
                                  : model.addJoint(parent, pinocchio::JointModelRZ(), se3, name);
        model.appendBodyToJoint(id, pinocchio::Inertia(mass, com, tensor), pinocchio::SE3::Identity());
    }
    if (!in)
        throw std::runtime_error("not a model");
    return model;
}
