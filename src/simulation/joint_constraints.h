#pragma once

#include "demo_logger/robot/robot_description.h"
#include "joint_row.h"

class btMultiBodyDynamicsWorld;

namespace demo_logger {

/// What holds one joint besides torque: Coulomb friction, which wants it to stand still and is as strong as the
/// friction, and the stop at either end of its range. A stop lets the joint come just to its limit within a step, so
/// the joint neither sinks in nor bounces off.
class JointConstraints {
 public:
  JointConstraints(btMultiBody& body, int index, const ArmJoint& joint);

  /// For the step to come, of length `step` [s].
  void prepare(double step);

  /// Impulse [N m s or N s] of friction in the last step.
  double frictionImpulse() { return friction_.impulse(); }

  void addTo(btMultiBodyDynamicsWorld& world);
  void removeFrom(btMultiBodyDynamicsWorld& world);

 private:
  const btMultiBody& body_;
  int index_;
  double coulomb_friction_;
  double lower_;
  double upper_;
  JointRow friction_;
  JointRow stop_;
};

}  // namespace demo_logger
