#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "demo_logger/channels/impedance.h"
#include "demo_logger/robot/robot_model.h"
#include "demo_logger/simulation/arm_command.h"
#include "demo_logger/simulation/bullet_arm.h"
#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

class Snapshot;

struct ArmControllerConfiguration {
  double control_period = 0.001;            // [s]
  double command_timeout = 0.5;             // [s] age of a command, by receipt or by stamp, at which the arm brakes
  double max_acceleration = 10.0;           // [rad/s² or m/s²] of every joint, for following and for braking
  double velocity_gain = 100.0;             // [1/s] k, how fast a velocity error is taken back
  double position_gain = 50.0;              // [1/s] how fast a position error is taken back
  double position_margin = 0.01;            // [rad or m] before a position limit at which the arm comes to rest
  bool effort_gravity_compensation = true;  // mode effort: commands come on top of gravity
  ImpedanceGains impedance;                 // mode impedance; what is empty is defaultImpedanceGains()
};

/// Throws ConfigurationError naming the field, its value with its unit and what was expected.
void validate(const ArmControllerConfiguration& configuration);

/// What the arm did with its commands in one control tick.
struct AppliedControl {
  ControlMode mode = ControlMode::velocity;
  std::vector<std::string> names;  // of the components of `command`
  Eigen::VectorXd command;         // in force during the tick, after limits; Cartesian ones in base axes; q_ref of mode
                                   // impedance; nothing in mode gravity_compensation
  Eigen::VectorXd torque;          // of the motors, held during the tick [N m or N]
  std::string reason;              // why `command` differs from what was asked; empty: it does not
};

constexpr double kHandover = 0.1;  // [s]

/// The controller inside an arm: commands in, motor torque out, once per control tick.
///   velocity, cartesian_velocity:  τ = M(q) (v̇_ref + k (v_ref − q̇)) + C(q, q̇) q̇ + g(q) + friction(v_ref)
///   position, trajectory:          the same, with v_ref = velocity of the target + what takes back the position error
///   effort:                        τ = commanded + g(q), or as commanded without effort_gravity_compensation
///   gravity_compensation:          τ = g(q)
///   impedance:                     τ = g(q) − K_p (q − q_ref) − K_d q̇
/// v_ref follows the command within the acceleration limit (each part of the sum in the bracket keeps that limit).
/// Joint commands are limited joint by joint; Cartesian ones are resolved by damped least squares and scaled as a
/// whole, so that the tip keeps its direction. Whatever is sent, velocities stay within the joints' limits, the arm
/// slows down in time to rest a margin before a position limit (and may always leave it), and torques stay within the
/// motors' limits. Without a sound and recent command (CommandGate) it brakes to rest.
/// The compliant modes need no command. They take over without a jump: q_ref is where the arm is in the first tick, and
/// what the motors gave before beyond the mode's own law fades within kHandover. Only at a limit of velocity, or near
/// one of position, do they resist the hand otherwise, as mode effort does. Nothing here reads a clock or allocates
/// threads; the same inputs give the same torques, bit for bit.
class ArmController {
 public:
  /// Throws ConfigurationError, also for unstable gains (requireStable), or ModelError if the arm has no inertia.
  ArmController(RobotDescription description, const ArmControllerConfiguration& configuration, ControlMode mode);
  ~ArmController();
  ArmController(ArmController&&) noexcept;
  ArmController& operator=(ArmController&&) noexcept;

  const ArmControllerConfiguration& configuration() const;
  ControlMode mode() const;
  /// What mode impedance gets if nothing else is said.
  const ImpedanceGains& impedanceGains() const;
  /// In force from the next tick on. Forgets the command in force: the arm brakes until there is one of the new mode,
  /// or complies. Mode impedance gets the configuration's gains, or `gains`, which must have passed requireStable().
  void setMode(ControlMode mode);
  void setMode(ControlMode mode, const ImpedanceGains& gains);

  /// The tick that starts at `now` [ns on the clock by which commands are received] in `state`, with the commands that
  /// came in since the last tick. `now` must not decrease.
  AppliedControl tick(Nanoseconds now, const ArmState& state, const std::vector<ArmCommand>& commands);

  /// The same arm with other masses: a load that the controller knows of.
  void setDescription(const RobotDescription& description);

  /// The reference at rest, no command in force, publishers' clocks unknown, as after construction.
  void reset();

  void exchange(Snapshot& snapshot);

  std::uint64_t refusedCommands() const;
  std::vector<std::string> clockMismatches() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace demo_logger
