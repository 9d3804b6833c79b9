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

/// `time` increases. Held: `effort` at t − h/2, by a cubic through the four samples around that instant (fewer where
/// some are missing or none come before). Instant: smoothed, where there are enough samples to tell noise from torque.
EffortSeries torqueAtStamps(const std::vector<double>& time, const Eigen::VectorXd& effort,
                            const EffortMetadata& meaning);

}  // namespace demo_logger
