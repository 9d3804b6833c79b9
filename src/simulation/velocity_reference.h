#pragma once

#include <Eigen/Core>
#include <vector>

#include "demo_logger/simulation/arm_controller.h"
#include "reasons.h"
#include "velocity_range.h"

namespace demo_logger {

class Snapshot;

/// The joint velocity v_ref that the arm is made to follow: goes after a target within the limits on velocity,
/// acceleration and position.
class VelocityReference {
 public:
  VelocityReference(const std::vector<ArmJoint>& joints, const ArmControllerConfiguration& configuration);

  /// One tick towards `target`. With `keep_direction` velocity and acceleration are scaled as wholes, so that the tip
  /// goes where it was sent, only slower; else each joint is limited by itself. Position limits have the last word.
  void step(const Eigen::VectorXd& target, const ArmState& state, bool keep_direction, Reasons& reasons);

  /// The arm is moved by something else: stay with it.
  void follow(const Eigen::VectorXd& velocity);

  void exchange(Snapshot& snapshot);

  const Eigen::VectorXd& velocity() const { return velocity_; }
  const Eigen::VectorXd& acceleration() const { return acceleration_; }

  /// The joints' ranges at the last step.
  const std::vector<VelocityRange>& ranges() const { return ranges_; }

 private:
  void explain(std::size_t joint, bool above, Reasons& reasons) const;

  std::vector<ArmJoint> joints_;
  BrakingRule rule_;
  double leash_;  // [rad/s or m/s] how far the reference may run ahead of the arm
  Eigen::VectorXd velocity_;
  Eigen::VectorXd acceleration_;
  std::vector<VelocityRange> ranges_;
};

}  // namespace demo_logger
