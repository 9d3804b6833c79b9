#include "compliant_law.h"

#include <limits>

#include "snapshot.h"

namespace demo_logger {

void CompliantLaw::engage(const ImpedanceGains& gains, const Eigen::VectorXd& torque, int fading_ticks) {
  gains_ = gains;
  q_ref_.resize(0);
  before_ = torque;
  excess_.resize(0);
  fading_ticks_ = fading_ticks;
  faded_ticks_ = 0;
}

Eigen::VectorXd CompliantLaw::torque(const RobotModel& model, const ArmState& state) {
  if (q_ref_.size() == 0) q_ref_ = state.q;
  // What the motors cannot give is cut off by the controller, which says so.
  const Eigen::VectorXd no_limit = Eigen::VectorXd::Constant(model.size(), std::numeric_limits<double>::infinity());
  Eigen::VectorXd own = impedanceTorque(gains_, model.gravity(state.q), state.q, state.dq, q_ref_, no_limit);
  if (before_.size() > 0) {
    excess_ = before_ - own;
    before_.resize(0);
  }
  if (excess_.size() == 0) return own;
  const double share = 1.0 - static_cast<double>(faded_ticks_) / static_cast<double>(fading_ticks_);
  own += share * excess_;
  if (++faded_ticks_ >= fading_ticks_) excess_.resize(0);
  return own;
}

void CompliantLaw::exchange(Snapshot& snapshot) {
  constexpr std::uint64_t kMostTicks = 1'000'000;
  snapshot.valueOrNone("stiffness", gains_.stiffness);
  snapshot.valueOrNone("damping", gains_.damping);
  snapshot.valueOrNone("reference", q_ref_);
  snapshot.valueOrNone("before", before_);
  snapshot.valueOrNone("excess", excess_);
  snapshot.count("fading_ticks", fading_ticks_, kMostTicks);
  snapshot.count("faded_ticks", faded_ticks_, kMostTicks);
}

}  // namespace demo_logger
