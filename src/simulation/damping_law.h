#pragma once

#include <Eigen/Core>

#include "demo_logger/robot/robot_model.h"

namespace demo_logger {

/// Viscous joint damping that explicit steps of length h can bear. Taken as −D q̇ it would diverge once h D exceeds
/// twice the joint's inertia (a light wrist with a stiff damper). Taken at the end of the step instead,
///   q̇⁺ = (M + h D)⁻¹ M q̇      that is, torque  −M (M + h D)⁻¹ D q̇,
/// it only ever brakes, and tends to −D q̇ for small h.
class DampingLaw {
 public:
  explicit DampingLaw(const RobotDescription& description);

  /// Prepares for steps of `step` [s] about configuration `q`.
  void update(const Eigen::VectorXd& q, double step);

  /// Adds the damping at velocity `dq` to `torque`.
  void addTo(Eigen::VectorXd& torque, const Eigen::VectorXd& dq) const;

 private:
  RobotModel model_;
  Eigen::VectorXd damping_;
  bool any_;
  Eigen::MatrixXd mass_;
  Eigen::MatrixXd gain_;
};

}  // namespace demo_logger
