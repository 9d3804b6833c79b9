#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
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
  Surroundings surroundings;
  Integrator integrator = Integrator::semi_implicit_euler;
  ControlMode mode = ControlMode::cartesian_velocity;  // in force at the start
  std::vector<double> initial_position;                // [rad or m] of every joint; empty: 0 or the nearest limit
  int substeps = 4;                                    // of the physics in one control tick
  bool load_declared = true;                           // the controller knows of a load and compensates its weight
};

/// Everything about one control tick, which starts at `stamp`.
struct ArmTick {
  std::uint64_t index = 0;  // counts from 0, through resets
  Nanoseconds stamp = 0;
  JointReading reading;  // of the sensors at `stamp`; effort: the motor torque held from `stamp` to the next tick, or
                         // that of a sensor at the link at `stamp`
  ArmState truth;        // at `stamp`
  Eigen::VectorXd external_torque;  // Jᵀ W of the wrenches upon the arm at `stamp` [N m or N]
  AppliedControl applied;
};

/// Why a wrench is refused, whatever the arm: not finite, or stronger than any arm stands. Empty if it is not.
std::string whyNotApplied(const LinkWrench& wrench);

/// An arm on the desk: motors, controller and sensors around Bullet's physics. One call is one control tick: sense,
/// take in the commands, decide on a torque, hold it until the next tick. The effort it reports is "held" with the
/// control period (EffortMetadata), or "instant" if it is measured at the link. Deterministic: the same configuration
/// and inputs give the same bits, from the start or from a saved state.
class SimulatedArm {
 public:
  /// Throws ConfigurationError, or ModelError if the arm cannot be simulated.
  SimulatedArm(const RobotDescription& description, const SimulatedArmConfiguration& configuration);

  /// The tick that starts at `now`, with the commands that came in since the last one. `now` must not decrease, and be
  /// a control period later than in the last call for the physics to agree with it.
  ArmTick tick(Nanoseconds now, const std::vector<ArmCommand>& commands);

  /// A wrench from the next tick on, before `until`. One with a `source` replaces the one before of that source, as the
  /// messages of a hand do; those without add up. Returns why it is refused, empty if it is not.
  std::string applyWrench(const LinkWrench& wrench, Nanoseconds until, const std::string& source = "");

  /// Something that was sent to the arm from `source` and cannot be a command: counted, and said with the next tick.
  void refuse(const std::string& source, const std::string& why);

  /// A load at the tip, its mass properties in the tip frame, instead of the one before; none: the hand is empty.
  /// Throws ModelError if the load is not physical.
  void setLoad(const std::optional<BodyInertia>& load);

  /// Back to the initial position, at rest, without a command or a wrench in force. Ticks go on counting, and the load
  /// stays.
  void reset();
  void setMode(ControlMode mode) { controller_.setMode(mode); }
  void setMode(ControlMode mode, const ImpedanceGains& gains) { controller_.setMode(mode, gains); }

  /// Everything that decides how it goes on, as JSON: of an arm with the same configuration, to be restored there.
  std::string saveState();
  /// Goes on from there, bit by bit as the saved one did, if the next tick is at `next`; the saved state's own next
  /// tick if that is not given. Throws ConfigurationError if it is no such state, or one of another arm.
  void restoreState(const std::string& json, std::optional<Nanoseconds> next = std::nullopt);

  const RobotDescription& description() const { return description_; }
  const ArmController& controller() const { return controller_; }
  const std::vector<Contact>& contacts() const { return body_.contacts(); }
  /// What the arm touches or overlaps where it is now, a sentence each.
  std::vector<std::string> overlaps() const;
  std::uint64_t refused() const { return controller_.refusedCommands() + refused_; }
  /// When the next tick is due, one period after the last; 0 before the first.
  Nanoseconds nextTick() const { return next_tick_; }

 private:
  static constexpr std::size_t kMostWrenches = 32;  // at once
  struct TimedWrench {
    LinkWrench wrench;
    Nanoseconds until = 0;
    std::string source;
  };
  void exchange(Snapshot& snapshot);
  void exchangeLoad(Snapshot& snapshot);
  void restoreBody(const ArmState& state, const Eigen::VectorXd& link_torque);
  void exchangeWrench(Snapshot& snapshot, TimedWrench& timed);

  RobotDescription description_;
  SimulatedArmConfiguration configuration_;
  ArmState initial_;
  BulletArm body_;
  ArmController controller_;
  JointSensors sensors_;
  std::optional<BodyInertia> load_;
  std::vector<TimedWrench> wrenches_;
  std::vector<std::string> refusals_;  // to be said with the next tick
  std::uint64_t refused_ = 0;
  std::uint64_t ticks_ = 0;
  Nanoseconds next_tick_ = 0;
};

}  // namespace demo_logger
