#pragma once

#include <random>
#include <string>

#include "demo_logger/robot/robot_description.h"
#include "src/robot/body_inertia.h"

namespace demo_logger {

/// Frames, axes, types and bodies at random; every body is four point masses, so its inertia is possible.
inline RobotDescription makeRandomArm(unsigned seed) {
  std::mt19937 generator(seed);
  const auto uniform = [&](double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(generator);
  };
  const auto vector = [&](double bound) {
    return Eigen::Vector3d(uniform(-bound, bound), uniform(-bound, bound), uniform(-bound, bound));
  };
  const auto pose = [&] {
    const Eigen::AngleAxisd turn(uniform(-3.0, 3.0), vector(1.0).normalized());
    return Eigen::Isometry3d(Eigen::Translation3d(vector(0.5)) * turn);
  };
  RobotDescription arm;
  arm.name = "random arm " + std::to_string(seed);
  arm.has_inertia = true;
  arm.gravity = 9.81 * vector(1.0).normalized();
  arm.X_lastlink_tip = pose();
  const int size = std::uniform_int_distribution<int>(1, 9)(generator);
  for (int i = 0; i < size; ++i) {
    ArmJoint joint;
    joint.name = "joint_" + std::to_string(i + 1);
    joint.link = "link_" + std::to_string(i + 1);
    joint.type = uniform(0.0, 1.0) < 0.3 ? JointType::prismatic : JointType::revolute;
    joint.X_parent_joint = pose();
    joint.axis = vector(1.0).normalized();
    for (int point = 0; point < 4; ++point) {
      BodyInertia mass;
      mass.mass = uniform(0.1, 2.0);
      mass.center = vector(0.2);
      joint.body = lumped(joint.body, mass);
    }
    arm.joints.push_back(joint);
  }
  return arm;
}

}  // namespace demo_logger
