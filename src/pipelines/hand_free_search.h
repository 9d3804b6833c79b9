#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "torque_equations.h"
#include "torque_regression.h"

namespace demo_logger {

struct HandFreeTolerance {
  Eigen::VectorXd largest;  // per joint, of a window's residual (root mean square) that no hand caused [N m or N]
  Eigen::VectorXd noise;    // per joint, what the sensors alone leave
};

/// Rows of which one set of parameters explains as many as possible to within the tolerance: where no hand is, as
/// fitModel's comment says. One flag for each row.
std::vector<bool> findHandFreeRows(const TorqueEquations& equations, const TorqueRegression& regression,
                                   const HandFreeTolerance& tolerance, const Prior& prior);

/// Of such rows, once more is known of the equations (the payload's inertia, at which velocity friction rises), those
/// that do not stick out of what is usual among them.
std::vector<bool> keepUsualRows(const TorqueEquations& equations, const TorqueRegression& regression,
                                const HandFreeTolerance& tolerance, const Prior& prior, const std::vector<bool>& rows);

}  // namespace demo_logger
