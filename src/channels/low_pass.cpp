#include "demo_logger/channels/low_pass.h"

#include <cmath>

#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/print.h"

namespace demo_logger {
namespace {

constexpr double kPi = 3.14159265358979323846;

}  // namespace

LowPass::LowPass(Eigen::Index size, double cutoff)
    : omega_(2.0 * kPi * cutoff), value_(Eigen::VectorXd::Zero(size)), rate_(Eigen::VectorXd::Zero(size)) {
  if (!(cutoff > 0.0) || !std::isfinite(cutoff)) {
    throw ConfigurationError("low-pass: the cut-off is " + print(cutoff) + " Hz, expected a positive number.");
  }
}

double LowPass::delay() const { return std::sqrt(2.0) / omega_; }

void LowPass::start(const Eigen::VectorXd& value) {
  value_ = value;
  rate_.setZero();
}

void LowPass::advance(double dt, const Eigen::VectorXd& input) {
  // The distance to the input decays as e^(−a t) (cos a t + …) with a = ω/√2, the filter's both poles' distance from
  // either axis.
  const double a = omega_ / std::sqrt(2.0);
  const double decay = std::exp(-a * dt);
  const double cosine = decay * std::cos(a * dt);
  const double sine = decay * std::sin(a * dt);
  for (Eigen::Index i = 0; i < value_.size(); ++i) {
    const double distance = value_[i] - input[i];
    const double rate = rate_[i];
    value_[i] = input[i] + distance * (cosine + sine) + rate * sine / a;
    rate_[i] = rate * (cosine - sine) - 2.0 * a * distance * sine;
  }
}

}  // namespace demo_logger
