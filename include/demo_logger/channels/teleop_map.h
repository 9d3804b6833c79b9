#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "demo_logger/trajectory/metadata.h"

namespace demo_logger {

/// What a device's reading h stands for.
///   rate: u = K_u h + b_u   u is a twist, v [m/s] then ω [rad/s]
///   pose: x = A h + b       x is a pose, position [m] then rotation vector [rad]; never quaternion components, of
///   which
///                           a linear map makes no rotation
enum class TeleopMode { rate, pose };

struct TeleopMapConfiguration {
  TeleopMode mode = TeleopMode::rate;
  std::vector<std::string> inputs;   // names of the k device readings
  std::vector<std::string> outputs;  // names of the m outputs
  Eigen::MatrixXd gain;              // m x k: K_u or A
  Eigen::VectorXd offset;            // m: b_u or b
  double dead_zone = 0.0;            // a reading this far from zero, or nearer, counts as zero; in the device's unit
  Eigen::VectorXd saturation;        // largest magnitude of each output; empty: none
};

/// One reading, mapped.
struct TeleopOutput {
  Eigen::VectorXd value;  // m
  bool linear = true;     // value = gain * reading + offset holds: neither dead zone nor saturation changed anything
};

/// The map from a device to the command, as it is recorded beside the demonstration. The dead zone is cut out, not
/// stretched over: beyond it the map is exactly linear, so that the recorded gain and offset explain the commands.
/// Saturation cuts each output by itself.
class TeleopMap {
 public:
  /// Throws ConfigurationError naming the field: sizes that disagree, values that are not finite, a negative dead zone,
  /// a saturation that is not positive, outputs other than six.
  explicit TeleopMap(TeleopMapConfiguration configuration);

  const TeleopMapConfiguration& configuration() const { return configuration_; }
  int inputs() const { return static_cast<int>(configuration_.gain.cols()); }

  /// `reading` is of length k. A reading that is not finite counts as zero, and the output as not linear.
  TeleopOutput map(const Eigen::VectorXd& reading) const;

  TeleopMapMetadata metadata() const;

 private:
  TeleopMapConfiguration configuration_;
};

/// The pose that an output of mode `pose` means: position, and rotation vector (axis times angle).
Eigen::Isometry3d toPose(const Eigen::VectorXd& output);

}  // namespace demo_logger
