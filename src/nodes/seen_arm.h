#pragma once

#include <sensor_msgs/JointState.h>

#include <optional>
#include <string>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/simulation/bullet_arm.h"

namespace demo_logger {

/// An arm as someone sees it who reads its joint states, whatever their order and whoever else is in them.
class SeenArm {
 public:
  explicit SeenArm(const RobotDescription& robot) : model_(robot) {}

  /// In the arm's joint order; nothing if a position (or, if they are asked for, a velocity) is missing or not finite.
  std::optional<ArmState> read(const sensor_msgs::JointState& state, bool with_velocities) const;

  /// The sentence about joint states on `topic` that could not be read.
  std::string complaint(const std::string& topic, bool with_velocities) const;

  const RobotModel& model() const { return model_; }

 private:
  RobotModel model_;
};

}  // namespace demo_logger
