#include "joint_constraints.h"

#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <algorithm>
#include <cmath>

namespace demo_logger {
namespace {

/// The speed [rad/s or m/s] at which a joint may approach a limit that is `room` away: to reach it in this step, not to
/// pass it. A joint that starts outside comes back slowly, for it keeps that speed.
double approachSpeed(double room, double step) {
  constexpr double kWayBack = 0.1;  // [rad/s or m/s]
  return std::max(room / step, -kWayBack);
}

}  // namespace

JointConstraints::JointConstraints(btMultiBody& body, int index, const ArmJoint& joint)
    : body_(body),
      index_(index),
      coulomb_friction_(joint.friction),
      lower_(joint.lower),
      upper_(joint.upper),
      friction_(body, index),
      stop_(body, index) {}

void JointConstraints::prepare(double step) {
  constexpr double kStrongest = 1e9;            // [N m s or N s]
  constexpr double kHighestAcceleration = 1e5;  // [rad/s² or m/s²]: nothing within reach of a step is overlooked
  if (coulomb_friction_ > 0.0) friction_.activate(0.0, -coulomb_friction_ * step, coulomb_friction_ * step);

  const double reach = 2.0 * std::abs(body_.getJointVel(index_)) * step + kHighestAcceleration * step * step;
  const double below = body_.getJointPos(index_) - lower_;
  const double above = upper_ - body_.getJointPos(index_);
  if (below < reach && below <= above) {
    stop_.activate(-approachSpeed(below, step), 0.0, kStrongest);
  } else if (above < reach) {
    stop_.activate(approachSpeed(above, step), -kStrongest, 0.0);
  } else {
    stop_.deactivate();
  }
}

void JointConstraints::addTo(btMultiBodyDynamicsWorld& world) {
  world.addMultiBodyConstraint(&friction_);
  world.addMultiBodyConstraint(&stop_);
}

void JointConstraints::removeFrom(btMultiBodyDynamicsWorld& world) {
  world.removeMultiBodyConstraint(&friction_);
  world.removeMultiBodyConstraint(&stop_);
}

}  // namespace demo_logger
