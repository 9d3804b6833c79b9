#include "velocity_range.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace demo_logger {
namespace {

constexpr double kShareOfVelocityLimit = 0.97;

/// Largest v with v h + v²/(2a) ≤ distance: one more period at v, then braking with a.
double brakingVelocity(double distance, const BrakingRule& rule) {
  if (std::isinf(distance)) return std::numeric_limits<double>::infinity();
  if (distance <= 0.0) return 0.0;
  const double step = rule.deceleration * rule.period;
  return std::sqrt(step * step + 2.0 * rule.deceleration * distance) - step;
}

}  // namespace

VelocityRange velocityRange(const ArmJoint& joint, double position, const BrakingRule& rule) {
  const double fastest = kShareOfVelocityLimit * joint.velocity_limit;
  const double to_upper = brakingVelocity(joint.upper - rule.margin - position, rule);
  const double to_lower = brakingVelocity(position - joint.lower - rule.margin, rule);
  return {-std::min(fastest, to_lower), std::min(fastest, to_upper), to_lower < fastest, to_upper < fastest};
}

}  // namespace demo_logger
