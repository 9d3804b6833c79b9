#include "demo_logger/simulation/gaussian_noise.h"

#include <cmath>

namespace demo_logger {
namespace {

constexpr double kTwoPi = 6.283185307179586;

}  // namespace

double GaussianNoise::uniform(double lower, double upper) {
  const double fraction = static_cast<double>(generator_() >> 11) * 0x1p-53;  // [0, 1), all 53 bits
  return lower + (upper - lower) * fraction;
}

double GaussianNoise::next() {  // Box and Muller's transform; its second number is not worth the memory
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(0.0, 1.0)));
  return radius * std::cos(uniform(0.0, kTwoPi));
}

}  // namespace demo_logger
