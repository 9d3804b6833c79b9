#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "demo_logger/robot/robot_description.h"
#include "demo_logger/simulation/arm_controller.h"
#include "demo_logger/simulation/bullet_arm.h"
#include "demo_logger/simulation/joint_sensors.h"
#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

struct SimulatedArmConfiguration {
  ArmControllerConfiguration controller;
  SensorConfiguration sensors;
  ControlMode mode = ControlMode::cartesian_velocity;  // in force at the start
  std::vector<double> initial_position;                // [rad or m] of every joint; empty: 0 or the nearest limit
  int substeps = 4;                                    // of the physics in one control tick
};

/// Everything about one control tick, which starts at `stamp`.
struct ArmTick {
  std::uint64_t index = 0;  // counts from 0, through resets
  Nanoseconds stamp = 0;
  JointReading reading;  // of the sensors at `stamp`; effort: the motor torque held from `stamp` to the next tick
  ArmState truth;        // at `stamp`
  AppliedControl applied;
};

/// An arm on the desk: motors, controller and sensors around Bullet's physics. One call is one control tick: sense,
/// take in the commands, decide on a torque, hold it until the next tick. The effort it reports is "held" with the
/// control period (EffortMetadata). Deterministic: the same configuration and inputs give the same bits.
class SimulatedArm {
 public:
  /// Throws ConfigurationError, or ModelError if the arm cannot be simulated.
  SimulatedArm(const RobotDescription& description, const SimulatedArmConfiguration& configuration);

  /// The tick that starts at `now`, with the commands that came in since the last one. `now` must not decrease, and be
  /// a control period later than in the last call for the physics to agree with it.
  ArmTick tick(Nanoseconds now, const std::vector<ArmCommand>& commands);

  /// Back to the initial position, at rest, without a command in force. Ticks go on counting.
  void reset();
  void setMode(ControlMode mode) { controller_.setMode(mode); }

  const RobotDescription& description() const { return description_; }
  const ArmController& controller() const { return controller_; }

 private:
  RobotDescription description_;
  SimulatedArmConfiguration configuration_;
  ArmState initial_;
  BulletArm body_;
  ArmController controller_;
  JointSensors sensors_;
  std::uint64_t ticks_ = 0;
};

}  // namespace demo_logger
