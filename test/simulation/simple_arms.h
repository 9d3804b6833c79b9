#pragma once

#include <string>

#include "demo_logger/robot/robot_description.h"

namespace demo_logger {

/// One joint about +y; its link is a point mass of 1 kg hanging 1 m below, so the inertia about the axis is 1 kg m².
/// No damping, no friction, no limits, and gravity only if asked for.
inline RobotDescription makePendulum(double gravity = 0.0) {
  ArmJoint joint;
  joint.name = "hinge";
  joint.link = "rod";
  joint.type = JointType::continuous;
  joint.axis = Eigen::Vector3d::UnitY();
  joint.body.mass = 1.0;
  joint.body.center = {0.0, 0.0, -1.0};
  RobotDescription pendulum;
  pendulum.name = "pendulum";
  pendulum.base = "ceiling";
  pendulum.tip = "rod";
  pendulum.joints = {joint};
  pendulum.X_lastlink_tip = Eigen::Translation3d(0.0, 0.0, -1.0);
  pendulum.gravity = {0.0, 0.0, -gravity};
  pendulum.has_inertia = true;
  return pendulum;
}

inline Eigen::VectorXd vector1(double value) { return Eigen::VectorXd::Constant(1, value); }

}  // namespace demo_logger
