#include "friction_share.h"

#include <algorithm>
#include <cmath>

namespace demo_logger {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kUniform = 1.0 / 3.0;  // variance of what is anything from -1 to 1
constexpr double kSlowest = 30.0;       // deviations of its velocity: a joint that never moved would have been as fast

}  // namespace

FrictionShare frictionShare(double velocity, double deviation, double friction_velocity, double usual_velocity) {
  const double sigma = std::max(deviation, 1e-12);
  if (friction_velocity > 0.0) {
    const double v = friction_velocity;
    const double mean = std::tanh(velocity / std::sqrt(v * v + 0.5 * kPi * sigma * sigma));
    const double in_doubt = sigma * sigma / (sigma * sigma + v * v);  // how much of that is the sign
    return {mean, (1.0 - mean * mean) * (in_doubt + (1.0 - in_doubt) * kUniform)};
  }
  const double z = velocity / sigma;
  const double usual = std::max(usual_velocity, kSlowest * sigma);
  const double odds = std::sqrt(2.0 * kPi) * sigma / (2.0 * std::sqrt(3.0) * usual) * std::exp(0.5 * z * z);
  const double stands = 1.0 / (1.0 + odds);
  const double mean = (1.0 - stands) * std::erf(z / std::sqrt(2.0));
  return {mean, stands * kUniform + (1.0 - stands) - mean * mean};
}

}  // namespace demo_logger
