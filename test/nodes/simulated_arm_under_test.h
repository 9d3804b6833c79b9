#pragma once

#include <demo_logger/AppliedCommand.h>
#include <demo_logger/SetControlMode.h>
#include <geometry_msgs/Twist.h>
#include <geometry_msgs/TwistStamped.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <std_srvs/Trigger.h>

#include <functional>
#include <string>
#include <vector>

#include "test/nodes/waiting.h"

namespace demo_logger {

inline const std::vector<double> kInitialPosition{0.0, 0.3, 0.0, 1.4, 0.0, 1.44, 0.0};  // config/demo_arm.yaml

/// How the arm refuses what this test sends.
inline std::string refusal(const std::string& why) { return "refused from " + ros::this_node::getName() + ": " + why; }

/// The arm of launch/simulated_arm.launch, brought back to its start before each test.
class SimulatedArmNodeTest : public testing::Test {
 protected:
  explicit SimulatedArmNodeTest(const std::string& name_space = "") : node(name_space) {}

  void SetUp() override {
    ASSERT_TRUE(
        ros::service::waitForService(node.resolveName("simulated_arm/reset_simulation"), ros::Duration(kPatience)));
    ASSERT_TRUE(applied.wait());
    setMode("cartesian_velocity");
    reset();
  }

  SetControlMode::Response setMode(const std::string& mode, const std::vector<double>& stiffness = {},
                                   const std::vector<double>& damping = {}) {
    SetControlMode call;
    call.request.mode = mode;
    call.request.stiffness = stiffness;
    call.request.damping = damping;
    EXPECT_TRUE(ros::service::call(node.resolveName("simulated_arm/set_control_mode"), call));
    return call.response;
  }

  void reset() {
    std_srvs::Trigger call;
    EXPECT_TRUE(ros::service::call(node.resolveName("simulated_arm/reset_simulation"), call));
    EXPECT_TRUE(call.response.success) << call.response.message;
  }

  /// Publishes again with every tick, as the commands of a device come, until `holds` of a tick.
  template <typename Message>
  bool send(ros::Publisher& publisher, Message message, const std::function<bool(const AppliedCommand&)>& holds,
            ros::Duration age = ros::Duration(0)) {
    std::size_t next = applied.messages().size();
    return waitFor([&] {
      stamp(message, ros::Time::now() - age);
      publisher.publish(message);
      for (; next < applied.messages().size(); ++next) {
        if (holds(applied.messages()[next])) return true;
      }
      return false;
    });
  }

  static void stamp(geometry_msgs::TwistStamped& message, const ros::Time& time) { message.header.stamp = time; }
  template <typename Message>
  static void stamp(Message& /*message*/, const ros::Time& /*time*/) {}

  static geometry_msgs::Twist makeTwist(double vy) {
    geometry_msgs::Twist twist;
    twist.linear.y = vy;
    return twist;
  }

  static geometry_msgs::TwistStamped makeStamped(double vy) {
    geometry_msgs::TwistStamped twist;
    twist.twist = makeTwist(vy);
    return twist;
  }

  template <typename Message>
  ros::Publisher advertise(const std::string& topic) {
    ros::Publisher publisher = node.advertise<Message>(topic, 10);
    EXPECT_TRUE(waitFor([&] { return publisher.getNumSubscribers() > 0; })) << topic << " has no subscriber";
    return publisher;
  }

  ros::NodeHandle node;
  Listener<AppliedCommand> applied{node, "applied_command"};
  Listener<sensor_msgs::JointState> joint_states{node, "joint_states"};
};

}  // namespace demo_logger
