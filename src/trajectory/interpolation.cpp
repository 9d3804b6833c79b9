#include "demo_logger/trajectory/interpolation.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace demo_logger {

double fractionBetween(Nanoseconds before, Nanoseconds instant, Nanoseconds after) {
  if (after == before) {
    return 0.0;
  }
  return static_cast<double>(instant - before) / static_cast<double>(after - before);
}

double interpolateLinearly(double from, double to, double fraction) {
  // Starting from the nearer end makes both ends exact, and a constant stay constant.
  return fraction < 0.5 ? from + (to - from) * fraction : to - (to - from) * (1.0 - fraction);
}

Eigen::Vector4d interpolateSpherically(const Eigen::Vector4d& from, const Eigen::Vector4d& to, double fraction) {
  const Eigen::Vector4d a = from.stableNormalized();
  Eigen::Vector4d b = to.stableNormalized();
  if (!from.allFinite() || !to.allFinite() || a.isZero(0.0) || b.isZero(0.0)) {
    return Eigen::Vector4d::Constant(std::numeric_limits<double>::quiet_NaN());
  }
  if (a.dot(b) < 0.0) {
    b = -b;
  }
  // Unlike acos(a·b), this angle is accurate for neighbours, which differ by less than the root of the precision.
  const double angle = 2.0 * std::atan2((a - b).norm(), (a + b).norm());
  if (angle < 1e-9) {
    return ((1.0 - fraction) * a + fraction * b).normalized();  // equal to first order, and defined at zero
  }
  const double sine = std::sin(angle);
  return (a * (std::sin((1.0 - fraction) * angle) / sine) + b * (std::sin(fraction * angle) / sine)).normalized();
}

}  // namespace demo_logger
