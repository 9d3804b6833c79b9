#pragma once

#include <Eigen/Core>
#include <vector>

#include "fit_problem.h"
#include "ridge_regression.h"
#include "torque_regression.h"

namespace demo_logger {

/// The regression of a problem on chosen rows, with weights that its own residuals give.
class ParameterFit {
 public:
  /// `largest`: per joint, how far residuals are thought to go before there are any.
  ParameterFit(FitProblem& problem, std::vector<bool> rows, const Eigen::VectorXd& largest);

  /// Until weights, friction velocities and the payload's own inertia have settled.
  void run();
  /// The nearest bodies that there can be stay, and the drives are fitted to them.
  void makeBodiesPossible();

  const RidgeEstimate& estimate() const { return estimate_; }

 private:
  Eigen::Index joints() const { return problem_.regression().joints; }

  template <typename Visit>
  void forEachRow(Eigen::Index joint, const Visit& visit) const {
    for (Eigen::Index k = 0; k < problem_.regression().rows(); ++k) {
      if (rows_[static_cast<std::size_t>(k)] && problem_.regression().says(k, joint)) visit(k);
    }
  }

  std::vector<JointSums> sums() const;
  /// How much the residuals of a joint say, row by row, though neighbours err alike: the variance that independent ones
  /// would have whose means over blocks vary as much.
  void judgeResiduals();
  /// For each joint the v that leaves the least, its own bias, damping and friction fitted anew.
  void chooseFrictionVelocities();
  double leftWith(Eigen::Index joint, double velocity) const;

  FitProblem& problem_;
  const std::vector<bool> rows_;
  Eigen::VectorXd variance_;
  RidgeEstimate estimate_;
};

}  // namespace demo_logger
