#include "demo_logger/channels/velocity_filter.h"

#include <cmath>
#include <limits>

#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/print.h"

namespace demo_logger {
namespace {

constexpr double kPi = 3.14159265358979323846;

}  // namespace

VelocityFilter::VelocityFilter(Eigen::Index joints, double cutoff)
    : omega_(2.0 * kPi * cutoff),
      last_(Eigen::VectorXd::Zero(joints)),
      velocity_(Eigen::VectorXd::Zero(joints)),
      rate_(Eigen::VectorXd::Zero(joints)) {
  if (!(cutoff > 0.0) || !std::isfinite(cutoff)) {
    throw ConfigurationError("velocity filter: the cut-off is " + print(cutoff) + " Hz, expected a positive number.");
  }
}

void VelocityFilter::restart() {
  started_ = false;
  velocity_.setZero();
  rate_.setZero();
}

double VelocityFilter::delay() const { return std::sqrt(2.0) / omega_; }

bool VelocityFilter::update(double dt, const Eigen::VectorXd& position, Eigen::VectorXd& velocity) {
  const double longest = 2.0 * kPi / (kFewestSamplesPerPeriod * omega_);
  if (!position.allFinite() || (started_ && !(dt > 0.0 && dt <= longest))) {
    restart();
    velocity.setConstant(position.size(), std::numeric_limits<double>::quiet_NaN());
    return false;
  }
  if (started_) {
    // The distance to the new input decays as e^(−a t) (cos a t + …) with a = ω/√2, the filter's both poles' distance
    // from either axis.
    const double a = omega_ / std::sqrt(2.0);
    const double decay = std::exp(-a * dt);
    const double cosine = decay * std::cos(a * dt);
    const double sine = decay * std::sin(a * dt);
    for (Eigen::Index i = 0; i < position.size(); ++i) {
      const double input = (position[i] - last_[i]) / dt;
      const double distance = velocity_[i] - input;
      const double rate = rate_[i];
      velocity_[i] = input + distance * (cosine + sine) + rate * sine / a;
      rate_[i] = rate * (cosine - sine) - 2.0 * a * distance * sine;
    }
  }
  started_ = true;
  last_ = position;
  velocity = velocity_;
  return true;
}

}  // namespace demo_logger
