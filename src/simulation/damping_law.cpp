#include "damping_law.h"

#include <Eigen/Cholesky>

namespace demo_logger {

DampingLaw::DampingLaw(const RobotDescription& description) : model_(description), damping_(model_.size()) {
  for (int i = 0; i < model_.size(); ++i) damping_[i] = description.joints[static_cast<std::size_t>(i)].damping;
  any_ = !damping_.isZero(0.0);
}

void DampingLaw::update(const Eigen::VectorXd& q, double step) {
  if (!any_) return;
  model_.massMatrix(q, mass_);
  gain_ = mass_;
  gain_.diagonal() += step * damping_;
  // M (M + h D)⁻¹ D, from the transpose of (M + h D)⁻¹ M: both are symmetric, their product is not.
  gain_ = gain_.llt().solve(mass_).transpose() * damping_.asDiagonal();
}

void DampingLaw::addTo(Eigen::VectorXd& torque, const Eigen::VectorXd& dq) const {
  if (any_) torque.noalias() -= gain_ * dq;
}

}  // namespace demo_logger
