#pragma once

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/simulation/arm_controller.h"
#include "joint_servo.h"
#include "reasons.h"

namespace demo_logger {

/// Lets a torque through unless a joint would leave its velocity range within about 1/(2k); then all joints get the
/// torque for the nearest acceleration that does not.
class EffortGuard {
 public:
  EffortGuard(const RobotModel& model, const JointServo& servo, const ArmControllerConfiguration& configuration);

  Eigen::VectorXd guarded(const Eigen::VectorXd& asked, const ArmState& state, Reasons& reasons) const;

 private:
  Eigen::VectorXd feasibleTorque(const Eigen::VectorXd& acceleration, const ArmState& state) const;

  const RobotModel& model_;
  const JointServo& servo_;
  ArmControllerConfiguration configuration_;
};

}  // namespace demo_logger
