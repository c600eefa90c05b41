/**
 * Stands in for the part of rclcpp that a generated node uses, after rclcpp's documentation of ROS 2 Humble.
 *
 * The parameters come from the environment variable PARAMETERS, the messages from standard input. What is
 * published and logged goes to standard output. It cannot show that the node works with ROS.
 */
#pragma once

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <std_msgs/msg/float64_multi_array.hpp>
#include <trajectory_msgs/msg/joint_trajectory.hpp>

namespace rclcpp {

struct Logger {};
struct Clock {};
struct QoS {
    explicit QoS(std::size_t) {}
};

inline Logger get_logger(const std::string&) { return {}; }

template <typename Message>
struct Publisher {
    using SharedPtr = std::shared_ptr<Publisher>;
    std::string topic;
    void publish(const Message& message)
    {
        std::printf("%s", topic.c_str());
        for (double x : message.data) {
            std::printf(" %.17g", x);
        }
        std::printf("\n");
    }
};

template <typename Message>
struct Subscription {
    using SharedPtr = std::shared_ptr<Subscription>;
    std::function<void(std::shared_ptr<const Message>)> callback;
};

inline std::function<void(std::shared_ptr<const trajectory_msgs::msg::JointTrajectory>)> subscriber;

class Node {
public:
    explicit Node(const std::string&) {}
    virtual ~Node() = default;
    Logger get_logger() const { return {}; }
    std::shared_ptr<Clock> get_clock() { return std::make_shared<Clock>(); }

    template <typename T>
    T declare_parameter(const std::string&, const T& value)
    {
        const char* text = std::getenv("PARAMETERS");
        if (text == nullptr) {
            return value;
        }
        T given;
        std::istringstream stream(text);
        for (double x; stream >> x;) {
            given.push_back(x);
        }
        return given;
    }

    template <typename Message>
    std::shared_ptr<Publisher<Message>> create_publisher(const std::string& topic, const QoS&)
    {
        return std::make_shared<Publisher<Message>>(Publisher<Message>{topic});
    }

    template <typename Message, typename Callback>
    std::shared_ptr<Subscription<Message>> create_subscription(const std::string&, const QoS&, Callback callback)
    {
        subscriber = callback;
        return std::make_shared<Subscription<Message>>(Subscription<Message>{callback});
    }
};

inline void init(int, char**) {}
inline void shutdown() {}

/** A message a line: number of points, then names, positions, velocities, accelerations, each with its length. */
inline void spin(std::shared_ptr<Node>)
{
    for (std::string line; std::getline(std::cin, line);) {
        std::istringstream stream(line);
        std::size_t points = 0, size = 0;
        auto message = std::make_shared<trajectory_msgs::msg::JointTrajectory>();
        trajectory_msgs::msg::JointTrajectoryPoint point;
        stream >> points >> size;
        message->joint_names.resize(size);
        for (auto& name : message->joint_names) {
            stream >> name;
        }
        for (auto* values : {&point.positions, &point.velocities, &point.accelerations}) {
            stream >> size;
            values->resize(size);
            for (double& x : *values) {
                stream >> x;
            }
        }
        message->points.assign(points, point);
        subscriber(message);
    }
}

} // namespace rclcpp

#define RCLCPP_WARN_THROTTLE(logger, clock, milliseconds, ...) \
    ((void)(logger), (void)(clock), (void)(milliseconds), std::printf(__VA_ARGS__), std::printf("\n"))
#define RCLCPP_FATAL(logger, ...) ((void)(logger), std::printf(__VA_ARGS__), std::printf("\n"))
