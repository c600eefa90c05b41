#pragma once

#include <memory>
#include <string>
#include <vector>

namespace trajectory_msgs::msg {
struct JointTrajectoryPoint {
    std::vector<double> positions, velocities, accelerations;
};
struct JointTrajectory {
    using ConstSharedPtr = std::shared_ptr<const JointTrajectory>;
    std::vector<std::string> joint_names;
    std::vector<JointTrajectoryPoint> points;
};
} // namespace trajectory_msgs::msg
