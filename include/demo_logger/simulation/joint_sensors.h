#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "demo_logger/simulation/bullet_arm.h"
#include "demo_logger/simulation/gaussian_noise.h"

namespace demo_logger {

class Snapshot;

/// Where the effort is measured, as in EffortMetadata.
enum class EffortSide { motor, link };

struct SensorConfiguration {
  double position_noise = 0.0;        // [rad or m] standard deviation
  double position_resolution = 0.0;   // [rad or m] step of the encoder; 0: none
  std::vector<double> position_bias;  // [rad or m] of each joint: a zero set wrongly; empty: none
  double velocity_noise = 0.0;        // [rad/s or m/s] standard deviation
  bool velocity_from_positions =
      false;                     // true: as drivers without a tachometer do, from one tick's reading to the next
  double velocity_cutoff = 0.0;  // [Hz] of a first-order low-pass over those differences; 0: none
  double effort_noise = 0.0;     // [N m or N] standard deviation
  EffortSide effort_side = EffortSide::motor;
  std::uint64_t seed = 1;
};

/// Throws ConfigurationError naming the field, for what is negative or not finite.
void validate(const SensorConfiguration& configuration);

/// What there is to sense at one tick.
struct JointTruth {
  ArmState state;
  Eigen::VectorXd motor_torque;  // [N m or N] held from this tick on
  Eigen::VectorXd link_torque;   // between gears and link, at this tick
};

struct JointReading {
  Eigen::VectorXd q;
  Eigen::VectorXd dq;
  Eigen::VectorXd effort;
};

/// What an arm's sensors make of the truth: Gaussian noise on everything, and on positions bias, noise and the
/// encoder's steps, in this order. Velocities are measured, or differences of positions over the period: zero at first.
/// The same seed and truth give the same readings; as configured by default the readings are the truth.
class JointSensors {
 public:
  /// `period` [s] from one reading to the next.
  explicit JointSensors(const SensorConfiguration& configuration, double period = 0.001);

  JointReading read(const JointTruth& truth);

  /// The arm was set elsewhere: no difference to what was before.
  void forgetPositions() { before_.resize(0); }

  void exchange(Snapshot& snapshot);

 private:
  Eigen::VectorXd disturbed(const Eigen::VectorXd& truth, double deviation);

  Eigen::VectorXd differenced(const Eigen::VectorXd& q);

  SensorConfiguration configuration_;
  double period_;
  GaussianNoise noise_;
  Eigen::VectorXd before_;    // positions read last
  Eigen::VectorXd velocity_;  // after the low-pass
};

}  // namespace demo_logger
