#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "demo_logger/simulation/bullet_arm.h"
#include "demo_logger/simulation/gaussian_noise.h"

namespace demo_logger {

struct SensorConfiguration {
  double position_noise = 0.0;       // [rad or m] standard deviation
  double position_resolution = 0.0;  // [rad or m] step of the encoder; 0: none
  double velocity_noise = 0.0;       // [rad/s or m/s] standard deviation
  double effort_noise = 0.0;         // [N m or N] standard deviation
  std::uint64_t seed = 1;
};

/// Throws ConfigurationError naming the field, for what is negative or not finite.
void validate(const SensorConfiguration& configuration);

struct JointReading {
  Eigen::VectorXd q;
  Eigen::VectorXd dq;
  Eigen::VectorXd effort;
};

/// What an arm's sensors make of the truth: Gaussian noise on everything, and on positions the encoder's steps after
/// the noise. The same seed and truth give the same readings; with all noise zero the readings are the truth.
class JointSensors {
 public:
  explicit JointSensors(const SensorConfiguration& configuration);

  JointReading read(const ArmState& truth, const Eigen::VectorXd& effort);

 private:
  Eigen::VectorXd disturbed(const Eigen::VectorXd& truth, double deviation);

  SensorConfiguration configuration_;
  GaussianNoise noise_;
};

}  // namespace demo_logger
