#include "demo_logger/channels/velocity_filter.h"

namespace demo_logger {
namespace {

constexpr double kTurn = 2.0 * 3.14159265358979323846;

}  // namespace

VelocityFilter::VelocityFilter(Eigen::Index joints, double cutoff)
    : filter_(joints, cutoff), last_(Eigen::VectorXd::Zero(joints)), quotient_(Eigen::VectorXd::Zero(joints)) {}

void VelocityFilter::restart() { has_position_ = has_velocity_ = false; }

double VelocityFilter::longestInterval() const { return kTurn / (kFewestSamplesPerPeriod * filter_.omega()); }

bool VelocityFilter::update(double dt, const Eigen::VectorXd& position) {
  if (!position.allFinite()) {
    restart();
    return false;
  }
  bool follows = has_position_ && dt > 0.0 && dt <= longestInterval();
  if (follows) {
    quotient_ = (position - last_) / dt;
    follows = (quotient_.array().abs() <= kFastest).all();
  }
  if (follows) {
    if (has_velocity_) {
      filter_.advance(dt, quotient_);
    } else {
      filter_.start(quotient_);
    }
  }
  has_position_ = true;
  has_velocity_ = follows;
  last_ = position;
  return follows;
}

void VelocityFilter::position(Eigen::VectorXd& result) const {
  const double omega = filter_.omega();
  result = last_ - filter_.delay() * filter_.value() - filter_.rate() / (omega * omega);
}

}  // namespace demo_logger
