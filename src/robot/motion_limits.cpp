#include "motion_limits.h"

#include <algorithm>
#include <cmath>

namespace demo_logger {
namespace {

// Differences of the positions round; so much of the limits is kept free that they never show more than the limit.
constexpr double kRounding = 1e-6;

}  // namespace

double brakingVelocity(double distance, double acceleration, double dt) {
  if (distance <= 0.0) return 0.0;
  // Covered in this step: what is left of the velocity is lost in the first half of the next one.
  if (!(distance > 0.5 * acceleration * dt * dt)) return distance / dt;
  // v dt + (v − a dt/2)²/(2 a) = distance
  return std::sqrt(2.0 * acceleration * distance) - 0.5 * acceleration * dt;
}

MotionLimits::MotionLimits(const RobotDescription& robot, double max_velocity, double max_acceleration)
    : acceleration_((1.0 - kRounding) * max_acceleration) {
  const auto n = static_cast<Eigen::Index>(robot.joints.size());
  lower_.resize(n);
  upper_.resize(n);
  velocity_.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const ArmJoint& joint = robot.joints[static_cast<std::size_t>(i)];
    lower_[i] = joint.lower;
    upper_[i] = joint.upper;
    velocity_[i] = (1.0 - kRounding) * std::min(joint.velocity_limit, max_velocity);
  }
}

void MotionLimits::box(const JointVector& q, const JointVector& velocity, double previous_dt, double dt,
                       MotionBox& box) const {
  const Eigen::Index n = q.size();
  box.lower.resize(n);
  box.upper.resize(n);
  // Braking is planned with a little less than is allowed, which absorbs rounding.
  const double braking = (1.0 - kRounding) * acceleration_;
  const double change = 0.5 * (previous_dt + dt) * acceleration_;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double fastest_up = std::min(velocity_[i], brakingVelocity(upper_[i] - q[i], braking, dt));
    const double fastest_down = -std::min(velocity_[i], brakingVelocity(q[i] - lower_[i], braking, dt));
    double low = std::max(fastest_down, velocity[i] - change);
    double high = std::min(fastest_up, velocity[i] + change);
    if (low > high) low = high = low > fastest_up ? fastest_up : fastest_down;  // by rounding
    box.lower[i] = low * dt;
    box.upper[i] = high * dt;
  }
}

}  // namespace demo_logger
