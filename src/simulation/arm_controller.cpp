#include "demo_logger/simulation/arm_controller.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "compliant_law.h"
#include "demo_logger/simulation/command_gate.h"
#include "demo_logger/simulation/compliance.h"
#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/quotation.h"
#include "effort_guard.h"
#include "joint_servo.h"
#include "path_follower.h"
#include "print.h"
#include "reasons.h"
#include "snapshot.h"
#include "twist_resolution.h"
#include "velocity_reference.h"

namespace demo_logger {
namespace {

const std::vector<std::string>& twistNames() {
  static const std::vector<std::string> names{"vx", "vy", "vz", "wx", "wy", "wz"};
  return names;
}

void require(bool holds, const std::string& field, double value, const std::string& unit, const std::string& expected) {
  if (holds && std::isfinite(value)) return;
  throw ConfigurationError("arm controller: " + field + " is " + print(value) + " " + unit + ", expected " + expected +
                           ".");
}

}  // namespace

void validate(const ArmControllerConfiguration& c) {
  require(c.control_period >= 1e-4 && c.control_period <= 0.01, "control_period", c.control_period, "s",
          "from 0.0001 to 0.01 s");
  require(c.command_timeout > 0.0 && c.command_timeout <= 60.0, "command_timeout", c.command_timeout, "s",
          "above 0, at most 60 s");
  require(c.max_acceleration > 0.0 && c.max_acceleration <= 1000.0, "max_acceleration", c.max_acceleration,
          "rad/s2 or m/s2", "above 0, at most 1000");
  require(c.velocity_gain > 0.0 && c.velocity_gain * c.control_period <= 0.5, "velocity_gain", c.velocity_gain, "1/s",
          "above 0, at most half the control rate, beyond which the loop would ring");
  require(c.position_gain > 0.0 && c.position_gain <= 0.5 * c.velocity_gain, "position_gain", c.position_gain, "1/s",
          "above 0, at most half the velocity_gain, beyond which the arm would overshoot");
  require(c.position_margin >= 0.0 && c.position_margin <= 0.5, "position_margin", c.position_margin, "rad or m",
          "from 0 to 0.5");
}

namespace {

std::vector<bool> slidingJoints(const RobotDescription& description) {
  std::vector<bool> slides;
  for (const ArmJoint& joint : description.joints) slides.push_back(joint.type == JointType::prismatic);
  return slides;
}

/// The velocity [rad/s or m/s] that takes back `error` [rad or m]: in proportion when it is small, and so that the arm
/// can brake in time when it is not. It leaves a part of the deceleration in hand.
double approachVelocity(double error, const ArmControllerConfiguration& configuration) {
  constexpr double kShareOfDeceleration = 0.7;
  const double most = kShareOfDeceleration * configuration.max_acceleration;
  const double step = most * configuration.control_period;
  const double in_time = std::sqrt(step * step + 2.0 * most * std::abs(error)) - step;
  return std::copysign(std::min(configuration.position_gain * std::abs(error), in_time), error);
}

}  // namespace

class ArmController::Implementation {
 public:
  Implementation(RobotDescription description, const ArmControllerConfiguration& configuration, ControlMode mode)
      : configuration_(configuration),
        mode_(mode),
        model_(std::move(description)),
        gate_({model_.description().jointNames(), model_.description().base, model_.description().tip,
               configuration.command_timeout, slidingJoints(model_.description())}),
        follower_(model_.description().joints, configuration.max_acceleration),
        reference_(model_.description().joints, configuration),
        servo_(model_, configuration),
        guard_(model_, servo_, configuration),
        gains_(configuredGains(model_.description(), configuration)) {
    if (isCompliant(mode_)) comply(gains_);
  }

  AppliedControl tick(Nanoseconds now, const ArmState& state, const std::vector<ArmCommand>& commands) {
    Reasons reasons;
    const bool sound = state.q.allFinite() && state.dq.allFinite();
    for (const ArmCommand& command : commands) {
      const std::string refusal = admit(command, now, state);
      if (refusal.empty()) continue;
      ++refused_;
      reasons.add("refused" + (command.source.empty() ? "" : " from " + shortened(command.source)) + ": " + refusal);
    }
    follower_.advance(now);
    const ArmCommand* command = gate_.inForce(now);
    if (command == nullptr && !isCompliant(mode_)) reasons.add(gate_.whyNone());

    AppliedControl applied;
    applied.mode = mode_;
    applied.names = componentNames();
    if (!sound) {
      reasons.add("the state of the arm is not finite; motors off");
      applied.command = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(applied.names.size()));
      applied.torque = Eigen::VectorXd::Zero(model_.size());
    } else {
      control(now, command, state, applied, reasons);
    }
    applied.reason = reasons.text();
    torque_ = applied.torque;
    return applied;
  }

  void setMode(ControlMode mode, const ImpedanceGains& gains) {
    mode_ = mode;
    follower_.clear();
    gate_.clear("no command yet since mode " + toString(mode) + " was chosen");
    if (isCompliant(mode)) comply(gains);
  }
  void setMode(ControlMode mode) { setMode(mode, gains_); }

  void reset() {
    reference_.follow(Eigen::VectorXd::Zero(model_.size()));
    follower_.clear();
    gate_.reset();
    torque_.resize(0);
    compliance_.reengage();
  }

  void setDescription(const RobotDescription& description) { model_ = RobotModel(description); }

  void exchange(Snapshot& snapshot) {
    std::string mode = toString(mode_);
    snapshot.value("mode", mode);
    mode_ = toControlMode(mode);
    snapshot.part("gate", [&](Snapshot& inside) { gate_.exchange(inside); });
    snapshot.part("path", [&](Snapshot& inside) { follower_.exchange(inside); });
    snapshot.part("reference", [&](Snapshot& inside) { reference_.exchange(inside); });
    snapshot.part("compliance", [&](Snapshot& inside) { compliance_.exchange(inside); });
    snapshot.valueOrNone("torque", torque_);
    snapshot.count("refused", refused_, Snapshot::kMostCounted);
    if (snapshot.reading() && gate_.holdsAnother(mode_)) {
      Snapshot::refuse("gate", "holds a command for another mode than " + mode);
    }
  }

  const ArmControllerConfiguration& configuration() const { return configuration_; }
  ControlMode mode() const { return mode_; }
  const ImpedanceGains& gains() const { return gains_; }
  std::uint64_t refused() const { return refused_; }
  std::vector<std::string> clockMismatches() const { return gate_.clockMismatches(); }

 private:
  const std::vector<ArmJoint>& joints() const { return model_.description().joints; }

  std::vector<std::string> componentNames() const {
    if (mode_ == ControlMode::gravity_compensation) return {};
    return mode_ == ControlMode::cartesian_velocity ? twistNames() : model_.description().jointNames();
  }

  /// What stands in the configuration, or else what suits the arm.
  static ImpedanceGains configuredGains(const RobotDescription& arm, const ArmControllerConfiguration& configuration) {
    const ImpedanceGains& given = configuration.impedance;
    const auto all = [](const Eigen::VectorXd& values) { return std::vector<double>(values.begin(), values.end()); };
    ImpedanceGains gains;
    if (given.stiffness.size() == 0 || given.damping.size() == 0) {
      gains = defaultImpedanceGains(arm, configuration.control_period);
    }
    gains = demo_logger::impedanceGains(arm, all(given.stiffness), all(given.damping), gains);
    requireStable(gains, arm, configuration.control_period);
    return gains;
  }

  void comply(const ImpedanceGains& gains) {
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(model_.size());
    const auto fading = static_cast<int>(std::lround(kHandover / configuration_.control_period));
    compliance_.engage(mode_ == ControlMode::impedance ? gains : ImpedanceGains{none, none}, torque_, fading);
  }

  /// A path must begin where the arm is meant to be, which a gate cannot know.
  std::string admit(const ArmCommand& command, Nanoseconds now, const ArmState& state) {
    if (mode_ != ControlMode::trajectory || command.mode != mode_) return gate_.admit(command, mode_, now);
    CommandGate trial = gate_;
    std::string refusal = trial.admit(command, mode_, now);
    if (!refusal.empty()) return refusal;
    const std::vector<PathPoint>& path = trial.inForce(now)->path;
    const Nanoseconds start = command.stamp == 0 ? now : command.stamp;
    const PathPoint present{0.0, state.q, reference_.velocity(), reference_.acceleration()};
    refusal = follower_.take(path, start, now, follower_.at(std::max(start, now)).value_or(present));
    if (!refusal.empty()) return refusal;
    if (path.empty()) trial.clear("stopped by an empty path");
    gate_ = std::move(trial);
    return "";
  }

  void control(Nanoseconds now, const ArmCommand* command, const ArmState& state, AppliedControl& applied,
               Reasons& reasons) {
    switch (mode_) {
      case ControlMode::effort:
        if (command != nullptr) return applyEffort(command->values, state, applied, reasons);
        brake(state, applied, reasons);
        applied.command = applied.torque;
        return;
      case ControlMode::velocity:
        if (command == nullptr) return brake(state, applied, reasons);
        return followVelocity(command->values, state, applied, reasons);
      case ControlMode::cartesian_velocity:
        return followTwist(command, state, applied, reasons);
      case ControlMode::position:
        if (command == nullptr) return stay(state, applied, reasons);
        return followPosition(targetOf(*command, now), state, applied, reasons);
      case ControlMode::trajectory:
        return followPath(now, state, applied, reasons);
      case ControlMode::gravity_compensation:
      case ControlMode::impedance:
        return giveWay(state, applied, reasons);
    }
  }

  void applyEffort(const Eigen::VectorXd& asked, const ArmState& state, AppliedControl& applied, Reasons& reasons) {
    reference_.follow(state.dq);
    Eigen::VectorXd compensation = Eigen::VectorXd::Zero(model_.size());
    if (configuration_.effort_gravity_compensation) compensation = model_.gravity(state.q);
    const Eigen::VectorXd torque = asked + compensation;
    applied.torque = guard_.guarded(torque, state, reasons);
    applied.command = applied.torque == torque ? asked : Eigen::VectorXd(applied.torque - compensation);
  }

  void giveWay(const ArmState& state, AppliedControl& applied, Reasons& reasons) {
    reference_.follow(state.dq);
    applied.torque = guard_.guarded(compliance_.torque(model_, state), state, reasons);
    applied.command = mode_ == ControlMode::impedance ? compliance_.reference() : Eigen::VectorXd();
  }

  void brake(const ArmState& state, AppliedControl& applied, Reasons& reasons) {
    moveAt(Eigen::VectorXd::Zero(model_.size()), /*keep_direction=*/true, state, applied, reasons);
    applied.command = reference_.velocity();
  }

  void followVelocity(const Eigen::VectorXd& velocity, const ArmState& state, AppliedControl& applied,
                      Reasons& reasons) {
    moveAt(velocity, /*keep_direction=*/false, state, applied, reasons);
    applied.command = reference_.velocity();
  }

  /// Without a position to go to.
  void stay(const ArmState& state, AppliedControl& applied, Reasons& reasons) {
    brake(state, applied, reasons);
    applied.command = state.q;
  }

  void moveAt(const Eigen::VectorXd& velocity, bool keep_direction, const ArmState& state, AppliedControl& applied,
              Reasons& reasons) {
    reference_.step(velocity, state, keep_direction, reasons);
    applied.torque = servo_.limited(servo_.trackingTorque(reference_, state, kUsualFrictionRise), reasons);
  }

  /// A target that moves goes on moving as it said until it says something else.
  PathPoint targetOf(const ArmCommand& command, Nanoseconds now) const {
    PathPoint target{0.0, command.values, Eigen::VectorXd::Zero(model_.size()), {}};
    if (command.rates.size() == 0) return target;
    target.dq = command.rates;
    target.q += toSeconds(now - gate_.receipt()) * command.rates;
    return target;
  }

  void followPosition(PathPoint target, const ArmState& state, AppliedControl& applied, Reasons& reasons) {
    constexpr double kFrictionRise = 0.002;  // [rad/s or m/s]
    Eigen::VectorXd velocity = target.dq;
    for (std::size_t i = 0; i < joints().size(); ++i) {
      const auto j = static_cast<Eigen::Index>(i);
      const double asked = target.q[j];
      target.q[j] = std::clamp(asked, joints()[i].lower, joints()[i].upper);
      if (target.q[j] != asked) {
        velocity[j] = 0.0;
        reasons.add("position of " + joints()[i].name + " limited to " + printPosition(joints()[i], target.q[j]));
      }
      velocity[j] += approachVelocity(target.q[j] - state.q[j], configuration_);
    }
    Reasons shape;  // getting there takes time, in which limits shape the motion: no intervention
    reference_.step(velocity, state, /*keep_direction=*/false, shape);
    applied.torque = servo_.limited(servo_.trackingTorque(reference_, state, kFrictionRise), reasons);
    applied.command = target.q;
  }

  void followPath(Nanoseconds now, const ArmState& state, AppliedControl& applied, Reasons& reasons) {
    constexpr double kFarthestBehind = 0.5;  // [rad or m]
    std::optional<PathPoint> point = follower_.at(now);
    if (!point) return stay(state, applied, reasons);
    point->dq = follower_.at(now + fromSeconds(configuration_.control_period))->dq;  // to be reached in this tick
    for (std::size_t i = 0; i < joints().size(); ++i) {
      const auto j = static_cast<Eigen::Index>(i);
      const double error = std::abs(point->q[j] - state.q[j]);
      if (error <= kFarthestBehind) continue;
      follower_.clear();
      gate_.clear("stopped: " + joints()[i].name + " was " + printPosition(joints()[i], error) + " off its path");
      reasons.add(gate_.whyNone());
      return stay(state, applied, reasons);
    }
    followPosition(*point, state, applied, reasons);
  }

  void followTwist(const ArmCommand* command, const ArmState& state, AppliedControl& applied, Reasons& reasons) {
    const Eigen::MatrixXd jacobian = model_.jacobian(state.q);
    Eigen::VectorXd twist = Eigen::VectorXd::Zero(6);
    if (command != nullptr) twist = inBaseAxes(*command, state);
    const ResolvedTwist resolved = resolveTwist(jacobian, twist);
    Reasons limits;
    if (resolved.damped) limits.add("near a singularity: the tip falls short of the twist, the joints stay slow");
    moveAt(resolved.velocity, /*keep_direction=*/true, state, applied, limits);
    const bool as_asked = limits.empty();
    reasons.addAll(limits);
    applied.command = as_asked ? twist : Eigen::VectorXd(jacobian * reference_.velocity());
  }

  Eigen::VectorXd inBaseAxes(const ArmCommand& command, const ArmState& state) const {
    const RobotDescription& arm = model_.description();
    if (command.frame.empty() || command.frame == arm.base) return command.values;
    const Eigen::Matrix3d R_base_tip = model_.forwardKinematics(state.q).linear();
    Eigen::VectorXd twist(6);
    twist << R_base_tip * command.values.head<3>(), R_base_tip * command.values.tail<3>();
    return twist;
  }

  ArmControllerConfiguration configuration_;
  ControlMode mode_;
  RobotModel model_;
  CommandGate gate_;
  PathFollower follower_;
  VelocityReference reference_;
  JointServo servo_;
  EffortGuard guard_;
  ImpedanceGains gains_;  // of the configuration
  CompliantLaw compliance_;
  Eigen::VectorXd torque_;  // of the last tick; empty: none since the start or a reset
  std::uint64_t refused_ = 0;
};

ArmController::ArmController(RobotDescription description, const ArmControllerConfiguration& configuration,
                             ControlMode mode) {
  validate(configuration);
  if (!description.has_inertia) {
    throw ModelError("arm controller: " + description.name + " cannot be controlled: " + description.inertia_fault +
                     ".");
  }
  implementation_ = std::make_unique<Implementation>(std::move(description), configuration, mode);
}

ArmController::~ArmController() = default;
ArmController::ArmController(ArmController&&) noexcept = default;
ArmController& ArmController::operator=(ArmController&&) noexcept = default;

const ArmControllerConfiguration& ArmController::configuration() const { return implementation_->configuration(); }
ControlMode ArmController::mode() const { return implementation_->mode(); }
const ImpedanceGains& ArmController::impedanceGains() const { return implementation_->gains(); }
void ArmController::setMode(ControlMode mode) { implementation_->setMode(mode); }
void ArmController::setMode(ControlMode mode, const ImpedanceGains& gains) { implementation_->setMode(mode, gains); }
void ArmController::reset() { implementation_->reset(); }
void ArmController::setDescription(const RobotDescription& description) {
  implementation_->setDescription(description);
}
void ArmController::exchange(Snapshot& snapshot) { implementation_->exchange(snapshot); }
std::uint64_t ArmController::refusedCommands() const { return implementation_->refused(); }
std::vector<std::string> ArmController::clockMismatches() const { return implementation_->clockMismatches(); }

AppliedControl ArmController::tick(Nanoseconds now, const ArmState& state, const std::vector<ArmCommand>& commands) {
  return implementation_->tick(now, state, commands);
}

}  // namespace demo_logger
