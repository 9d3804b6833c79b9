#pragma once

#include <Eigen/Core>
#include <vector>

#include "constraint_problem.h"
#include "demo_logger/robot/robot_description.h"
#include "demo_logger/simulation/bullet_arm.h"

namespace demo_logger {

/// What holds the joints besides torque: Coulomb friction, which wants a joint to stand still and is as strong as the
/// friction, and the stops at either end of its range. A stop lets the joint come just to its limit within a step, so
/// the joint neither sinks in nor bounces off.
class JointConstraints {
 public:
  explicit JointConstraints(const std::vector<ArmJoint>& joints);

  /// Adds the rows for a step of length `step` [s] from `state`.
  void addTo(ConstraintProblem& problem, const ArmState& state, double step);

  /// Adds the impulse [N m s or N s] of friction in the step that `problem` was solved for.
  void addFrictionImpulse(const ConstraintProblem& problem, Eigen::VectorXd& impulse) const;

 private:
  struct Joint {
    double friction;
    double lower;
    double upper;
    int friction_row;
  };
  std::vector<Joint> joints_;
};

}  // namespace demo_logger
