#include "comfort.h"

#include <algorithm>
#include <cmath>

namespace demo_logger {
namespace {

constexpr double kCentring = 0.5;     // [rad/s or m/s] at two thirds of the way from the middle to a limit
constexpr double kDexterity = 0.1;    // [rad²/s] per unit of the logarithm
constexpr double kFastest = 2.0;      // [rad/s or m/s]
constexpr double kAtLimit = 0.999;    // share of the half range that counts as the limit
constexpr double kDifference = 1e-4;  // [rad or m] for the slope of the dexterity

}  // namespace

void comfortVelocity(const JointVector& q, const MotionLimits& limits, StepSolver& solver, JointVector& velocity) {
  const Eigen::Index n = q.size();
  velocity.setZero(n);
  if (n > 6) {
    const double here = solver.logDexterity(q);
    JointVector beside = q;
    for (Eigen::Index i = 0; i < n; ++i) {
      beside[i] = q[i] + kDifference;
      velocity[i] = kDexterity * (solver.logDexterity(beside) - here) / kDifference;
      beside[i] = q[i];
    }
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const double half = 0.5 * (limits.upper()[i] - limits.lower()[i]);
    if (std::isfinite(half) && half > 0.0) {
      const double share = std::clamp((q[i] - limits.lower()[i]) / half - 1.0, -kAtLimit, kAtLimit);
      velocity[i] -= kCentring * share / (1.0 - share * share);
    }
    const double fastest = std::min(kFastest, limits.velocity()[i]);
    velocity[i] = std::clamp(velocity[i], -fastest, fastest);
  }
}

}  // namespace demo_logger
