#pragma once

#include <Eigen/Core>
#include <vector>

#include "demo_logger/trajectory/metadata.h"

namespace demo_logger {

/// What one joint's efforts say of the torque at the stamps themselves.
struct EffortSeries {
  Eigen::VectorXd torque;    // [N m or N], NaN where it is not known
  Eigen::VectorXd variance;  // of the sensor's noise; 0 for commands
};

/// `time` increases. Held: `effort` at t − h/2, by a cubic through the four known samples around that instant; along a
/// straight line across samples that are missing; as the first known one before that, for nothing is extrapolated.
/// Instant: smoothed, where there are enough samples to tell noise from torque.
EffortSeries torqueAtStamps(const std::vector<double>& time, const Eigen::VectorXd& effort,
                            const EffortMetadata& meaning);

}  // namespace demo_logger
