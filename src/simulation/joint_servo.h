#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/simulation/arm_controller.h"
#include "reasons.h"
#include "velocity_reference.h"

namespace demo_logger {

/// Motor torques from what the joints shall do:
///   τ = (M(q) + B) (v̇_ref + k (v_ref − q̇)) + C(q, q̇) q̇ + g(q) + friction(v_ref)
/// each part of the sum in the bracket within the acceleration limit.
class JointServo {
 public:
  JointServo(const RobotModel& model, const ArmControllerConfiguration& configuration);

  /// `friction_rise` [rad/s or m/s]: over this velocity Coulomb friction is compensated more and more. Small, the arm
  /// comes nearer to a position; large, an arm at rest is held by its own stiction, not by a motor that chatters.
  Eigen::VectorXd trackingTorque(const VelocityReference& reference, const ArmState& state, double friction_rise) const;

  /// (M(q) + B) q̈ + C(q, q̇) q̇ + g(q), B the inertia of the motors
  Eigen::VectorXd inverseDynamics(const ArmState& state, const Eigen::VectorXd& acceleration) const;
  Eigen::VectorXd friction(const Eigen::VectorXd& velocity, double rise) const;

  /// Within what the motors can give.
  Eigen::VectorXd limited(Eigen::VectorXd torque, Reasons& reasons) const;

 private:
  const std::vector<ArmJoint>& joints() const { return model_.description().joints; }

  const RobotModel& model_;
  double gain_;
  double max_acceleration_;
};

constexpr double kUsualFrictionRise = 0.01;  // [rad/s or m/s]

}  // namespace demo_logger
