#include "demo_logger/simulation/arm_controller.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "demo_logger/simulation/command_gate.h"
#include "demo_logger/trajectory/error.h"
#include "print.h"
#include "reasons.h"
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
  require(c.position_margin >= 0.0 && c.position_margin <= 0.5, "position_margin", c.position_margin, "rad or m",
          "from 0 to 0.5");
}

class ArmController::Implementation {
 public:
  Implementation(RobotDescription description, const ArmControllerConfiguration& configuration, ControlMode mode)
      : configuration_(configuration),
        mode_(mode),
        model_(std::move(description)),
        gate_({model_.description().jointNames(), model_.description().base, model_.description().tip,
               configuration.command_timeout}),
        reference_(model_.description().joints, configuration) {}

  AppliedControl tick(Nanoseconds now, const ArmState& state, const std::vector<ArmCommand>& commands) {
    Reasons reasons;
    for (const ArmCommand& command : commands) {
      const std::string refusal = gate_.admit(command, mode_, now);
      if (refusal.empty()) continue;
      ++refused_;
      reasons.add("refused: " + refusal);
    }
    const ArmCommand* command = gate_.inForce(now);
    if (command == nullptr) reasons.add(gate_.whyNone());

    AppliedControl applied;
    applied.mode = mode_;
    applied.names = mode_ == ControlMode::cartesian_velocity ? twistNames() : model_.description().jointNames();
    if (!state.q.allFinite() || !state.dq.allFinite()) {
      reasons.add("the state of the arm is not finite; motors off");
      applied.command = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(applied.names.size()));
      applied.torque = Eigen::VectorXd::Zero(model_.size());
    } else if (mode_ == ControlMode::effort && command != nullptr) {
      applied.torque = guardEffort(command->values, state, reasons);
      applied.command = applied.torque;
    } else if (mode_ == ControlMode::cartesian_velocity) {
      applied.command = followTwist(command, state, applied.torque, reasons);
    } else {
      followVelocity(mode_ == ControlMode::velocity ? command : nullptr, state, applied.torque, reasons);
      applied.command = mode_ == ControlMode::velocity ? reference_.velocity() : applied.torque;
    }
    applied.reason = reasons.text();
    return applied;
  }

  void setMode(ControlMode mode) {
    mode_ = mode;
    gate_.clear("no command yet since mode " + toString(mode) + " was chosen");
  }

  void reset() {
    reference_.follow(Eigen::VectorXd::Zero(model_.size()));
    gate_.reset();
  }

  const ArmControllerConfiguration& configuration() const { return configuration_; }
  ControlMode mode() const { return mode_; }
  std::uint64_t refused() const { return refused_; }
  std::vector<std::string> clockMismatches() const { return gate_.clockMismatches(); }

 private:
  const std::vector<ArmJoint>& joints() const { return model_.description().joints; }

  void followVelocity(const ArmCommand* command, const ArmState& state, Eigen::VectorXd& torque, Reasons& reasons) {
    const Eigen::VectorXd target = command != nullptr ? command->values : Eigen::VectorXd::Zero(model_.size());
    reference_.step(target, state, /*keep_direction=*/command == nullptr, reasons);
    torque = limitTorque(trackingTorque(state), reasons);
  }

  /// Returns the twist in force in base axes.
  Eigen::VectorXd followTwist(const ArmCommand* command, const ArmState& state, Eigen::VectorXd& torque,
                              Reasons& reasons) {
    const Eigen::MatrixXd jacobian = model_.jacobian(state.q);
    Eigen::VectorXd twist = Eigen::VectorXd::Zero(6);
    if (command != nullptr) twist = inBaseAxes(*command, state);
    const ResolvedTwist resolved = resolveTwist(jacobian, twist);
    Reasons limits;
    if (resolved.damped) limits.add("near a singularity: the tip falls short of the twist, the joints stay slow");
    reference_.step(resolved.velocity, state, /*keep_direction=*/true, limits);
    torque = limitTorque(trackingTorque(state), limits);
    const bool as_asked = limits.empty();
    reasons.addAll(limits);
    return as_asked ? twist : jacobian * reference_.velocity();
  }

  Eigen::VectorXd inBaseAxes(const ArmCommand& command, const ArmState& state) const {
    const RobotDescription& arm = model_.description();
    if (command.frame.empty() || command.frame == arm.base) return command.values;
    const Eigen::Matrix3d R_base_tip = model_.forwardKinematics(state.q).linear();
    Eigen::VectorXd twist(6);
    twist << R_base_tip * command.values.head<3>(), R_base_tip * command.values.tail<3>();
    return twist;
  }

  /// τ = M (v̇_ref + k (v_ref − q̇)) + h + friction(v_ref), the correction within the acceleration limit.
  Eigen::VectorXd trackingTorque(const ArmState& state) const {
    const double most = configuration_.max_acceleration;
    const Eigen::VectorXd correction =
        (configuration_.velocity_gain * (reference_.velocity() - state.dq)).cwiseMax(-most).cwiseMin(most);
    return model_.inverseDynamics(state.q, state.dq, reference_.acceleration() + correction) +
           friction(reference_.velocity());
  }

  /// Of the joints at this velocity. Coulomb friction rises over a small velocity instead of at once: at rest the arm's
  /// own stiction shall hold it, not a motor that chatters.
  Eigen::VectorXd friction(const Eigen::VectorXd& velocity) const {
    constexpr double kRise = 0.01;  // [rad/s or m/s]
    Eigen::VectorXd torque(velocity.size());
    for (std::size_t i = 0; i < joints().size(); ++i) {
      const double v = velocity[static_cast<Eigen::Index>(i)];
      torque[static_cast<Eigen::Index>(i)] = joints()[i].damping * v + joints()[i].friction * std::tanh(v / kRise);
    }
    return torque;
  }

  /// Lets a torque through unless a joint would leave its velocity range within about 1/(2k); then all joints get the
  /// torque for the nearest acceleration that does not.
  Eigen::VectorXd guardEffort(const Eigen::VectorXd& asked, const ArmState& state, Reasons& reasons) {
    reference_.follow(state.dq);
    Eigen::VectorXd torque = limitTorque(asked, reasons);
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(model_.size());
    const Eigen::VectorXd bias = model_.inverseDynamics(state.q, state.dq, rest) + friction(state.dq);
    const Eigen::VectorXd predicted = model_.massMatrix(state.q).llt().solve(torque - bias);
    Eigen::VectorXd allowed = predicted;
    const double most = configuration_.max_acceleration;
    // This law sees one tick ahead and knows no stiction: it is stiff, and keeps half the deceleration and a part of
    // the velocity in hand.
    constexpr double kShareOfVelocity = 0.95;
    const double gain = 2.0 * configuration_.velocity_gain;
    const BrakingRule rule{most / 2.0, configuration_.control_period, configuration_.position_margin};
    for (std::size_t i = 0; i < joints().size(); ++i) {
      const auto j = static_cast<Eigen::Index>(i);
      const VelocityRange range = velocityRange(joints()[i], state.q[j], rule);
      const double fastest = gain * (kShareOfVelocity * range.upper - state.dq[j]);
      const double slowest = gain * (kShareOfVelocity * range.lower - state.dq[j]);
      allowed[j] = std::clamp(predicted[j], slowest, fastest);
      if (allowed[j] == predicted[j]) continue;
      const bool by_position = predicted[j] > fastest ? range.upper_by_position : range.lower_by_position;
      reasons.add(joints()[i].name +
                  (by_position ? " braked before its position limit" : " braked at its velocity limit"));
    }
    if (allowed == predicted) return torque;
    // Once it interferes, no joint shall be so quick that the others' forces change within the tick.
    const double quickest = 10.0 * most;
    return feasibleTorque(allowed.cwiseMax(-quickest).cwiseMin(quickest), state);
  }

  /// The torque for `acceleration`, or where a motor is too weak for it, for something between it and braking all
  /// joints: clamping that motor alone would let the others push it over its limit.
  Eigen::VectorXd feasibleTorque(const Eigen::VectorXd& acceleration, const ArmState& state) const {
    const double most = configuration_.max_acceleration;
    const Eigen::VectorXd braking = (-configuration_.velocity_gain * state.dq).cwiseMax(-most).cwiseMin(most);
    const Eigen::VectorXd resisting = friction(state.dq);
    Eigen::VectorXd torque = model_.inverseDynamics(state.q, state.dq, braking) + resisting;
    const Eigen::VectorXd more = model_.inverseDynamics(state.q, state.dq, acceleration) + resisting - torque;
    double share = 1.0;
    for (Eigen::Index i = 0; i < torque.size(); ++i) {
      const double room = joints()[static_cast<std::size_t>(i)].effort_limit - std::copysign(1.0, more[i]) * torque[i];
      if (std::abs(more[i]) > room) share = std::min(share, std::max(room, 0.0) / std::abs(more[i]));
    }
    torque += share * more;
    Reasons known;
    return limitTorque(torque, known);
  }

  Eigen::VectorXd limitTorque(Eigen::VectorXd torque, Reasons& reasons) const {
    for (std::size_t i = 0; i < joints().size(); ++i) {
      double& effort = torque[static_cast<Eigen::Index>(i)];
      const double limit = joints()[i].effort_limit;
      if (std::abs(effort) <= limit) continue;
      effort = std::copysign(limit, effort);
      reasons.add("effort of " + joints()[i].name + " limited to " + printEffort(joints()[i], limit));
    }
    return torque;
  }

  ArmControllerConfiguration configuration_;
  ControlMode mode_;
  RobotModel model_;
  CommandGate gate_;
  VelocityReference reference_;
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
void ArmController::setMode(ControlMode mode) { implementation_->setMode(mode); }
void ArmController::reset() { implementation_->reset(); }
std::uint64_t ArmController::refusedCommands() const { return implementation_->refused(); }
std::vector<std::string> ArmController::clockMismatches() const { return implementation_->clockMismatches(); }

AppliedControl ArmController::tick(Nanoseconds now, const ArmState& state, const std::vector<ArmCommand>& commands) {
  return implementation_->tick(now, state, commands);
}

}  // namespace demo_logger
