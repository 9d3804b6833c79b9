#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "demo_logger/channels/low_pass.h"
#include "demo_logger/channels/momentum_observer.h"
#include "demo_logger/channels/velocity_filter.h"
#include "demo_logger/pipelines/model_calibration.h"
#include "demo_logger/robot/robot_model.h"
#include "demo_logger/trajectory/metadata.h"
#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

struct HumanTorqueObserverConfiguration {
  EffortMetadata effort;  // what the efforts mean
  /// Where an effort is missing, the motors count as compensating gravity, τ_c = g(q), and nothing else.
  bool gravity_compensated = false;
  double gain = 50.0;    // [1/s] K_o: larger is faster, and noisier
  double cutoff = 30.0;  // [Hz] of the velocity filter
};

/// Throws ConfigurationError naming the field, its value with its unit and what was expected.
void validate(const HumanTorqueObserverConfiguration& configuration);

/// The torque that a person exerts on the joints, as it happens, from joint states one by one: the momentum observer
/// with p = M(q) q̇ and u = Cᵀ q̇ − g − friction, q̇ from positions by the velocity filter (measured velocities are not
/// asked for: how they were filtered is not known). Positions and motor torques pass the same filter, so that
/// everything the observer weighs against each other is late alike. In hindsight addHumanTorque knows better.
///   side motor: motor inertia and friction of the drives belong to the arm; side link: they do not, unless the arm's
///               calibration was made with such efforts. Its torque bias is taken off them alike.
///   held:       an effort acts from its stamp on, for the control period; where the log is slower than the controller,
///               the torque between two stamps is that of the straight line through (stamp + half a control period)
///   instant:    the same with a control period of zero, the trapezium
/// Coulomb friction without a velocity of its own counts as F tanh(q̇ / kFrictionVelocity): the sign of a filtered
/// velocity near zero is noise.
/// The torque comes delay() late: 1/K_o + √2/ω. After the beginning, a gap, a value that is not finite or a clock that
/// goes back, it is NaN for 5/K_o. Nothing is allocated after construction.
class HumanTorqueObserver {
 public:
  static constexpr double kFrictionVelocity = 0.01;  // [rad/s or m/s]

  /// Throws ConfigurationError, or ModelError for an arm without inertia.
  HumanTorqueObserver(const CalibratedArm& arm, const HumanTorqueObserverConfiguration& configuration);

  /// Forgets everything.
  void restart();

  /// One joint state: q and effort of every joint of the arm, in its order. Returns false, and NaN in `torque`, where
  /// nothing is known yet or any more. `torque` is resized if need be.
  bool update(Nanoseconds stamp, const Eigen::VectorXd& q, const Eigen::VectorXd& effort, Eigen::VectorXd& torque);

  const RobotDescription& robot() const { return model_.description(); }
  double delay() const { return observer_.delay() + motion_filter_.delay(); }  // [s]
  /// [s] between joint states, beyond which the velocity filter, and so this, gives nothing.
  double longestInterval() const { return motion_filter_.longestInterval(); }

 private:
  bool takeMotorTorque(const Eigen::VectorXd& q, const Eigen::VectorXd& effort);
  void filterMotorTorque(double dt);
  bool findMomentumAndForces();
  bool addMassRate();

  RobotModel model_;
  const HumanTorqueObserverConfiguration configuration_;
  const Eigen::VectorXd bias_;
  VelocityFilter motion_filter_;
  LowPass torque_filter_;
  MomentumObserver observer_;
  bool motors_known_ = false;  // τ_c, at the last sample
  bool following_ = false;     // the torque filter has begun
  Nanoseconds last_stamp_ = 0;
  Eigen::VectorXd motor_torque_, last_motor_torque_, mean_motor_torque_;  // τ_c
  Eigen::VectorXd q_, dq_, momentum_, forces_;  // q, q̇, p, u, as late as the filter makes them
  Eigen::VectorXd gravity_, friction_, work_;
  Eigen::MatrixXd mass_, mass_ahead_, mass_behind_;
};

}  // namespace demo_logger
