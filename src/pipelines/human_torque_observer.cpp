#include "demo_logger/pipelines/human_torque_observer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/not_a_number.h"
#include "demo_logger/trajectory/print.h"
#include "joint_columns.h"

namespace demo_logger {
namespace {

constexpr double kAhead = 1e-4;  // [rad or m] along q̇, where M is looked at to tell Ṁ

/// Coulomb friction that does not change its sign with the noise of a filtered velocity.
RobotDescription withGentleFriction(RobotDescription robot) {
  for (ArmJoint& joint : robot.joints) {
    if (joint.friction_velocity == 0.0) joint.friction_velocity = HumanTorqueObserver::kFrictionVelocity;
  }
  return robot;
}

void requirePositive(const char* field, double value, const char* unit) {
  if (value > 0.0 && std::isfinite(value)) return;
  throw ConfigurationError(std::string(field) + " is " + print(value) + " " + unit + ", expected a positive number.");
}

}  // namespace

void validate(const HumanTorqueObserverConfiguration& configuration) {
  requirePositive("gain", configuration.gain, "1/s");
  requirePositive("cutoff", configuration.cutoff, "Hz");
  validate(configuration.effort);
}

HumanTorqueObserver::HumanTorqueObserver(const CalibratedArm& arm,
                                         const HumanTorqueObserverConfiguration& configuration)
    : model_(withGentleFriction((validate(configuration), arm.seenAt(configuration.effort.side)))),
      configuration_(configuration),
      bias_(arm.biasAt(configuration.effort.side)),
      motion_filter_(model_.size(), configuration.cutoff),
      torque_filter_(model_.size(), configuration.cutoff),
      observer_(model_.size(), configuration.gain) {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(model_.size());
  motor_torque_ = last_motor_torque_ = mean_motor_torque_ = q_ = dq_ = momentum_ = forces_ = gravity_ = friction_ =
      work_ = zero;
  mass_ = mass_ahead_ = mass_behind_ = model_.massMatrix(zero);  // asks for inertia
}

void HumanTorqueObserver::restart() {
  motion_filter_.restart();
  observer_.restart();
  following_ = motors_known_ = false;
}

bool HumanTorqueObserver::update(Nanoseconds stamp, const Eigen::VectorXd& q, const Eigen::VectorXd& effort,
                                 Eigen::VectorXd& torque) {
  torque.setConstant(model_.size(), kNaN);
  const double dt = toSeconds(stamp - last_stamp_);
  last_stamp_ = stamp;
  last_motor_torque_.swap(motor_torque_);
  const bool moving_on = motion_filter_.update(dt, q);
  const bool known_before = std::exchange(motors_known_, takeMotorTorque(q, effort));
  if (!moving_on || !known_before || !motors_known_) {
    observer_.restart();
    following_ = false;
    return false;
  }
  filterMotorTorque(dt);
  if (!findMomentumAndForces()) {
    restart();
    return false;
  }
  return observer_.update(dt, momentum_, forces_, mean_motor_torque_, torque);
}

/// τ_c at this instant; false where it is not known.
bool HumanTorqueObserver::takeMotorTorque(const Eigen::VectorXd& q, const Eigen::VectorXd& effort) {
  const bool adds_gravity = !configuration_.effort.includes_gravity || configuration_.gravity_compensated;
  if (adds_gravity && !model_.gravity(q, gravity_)) return false;
  for (Eigen::Index i = 0; i < effort.size(); ++i) {
    const bool unsaid = std::isnan(effort[i]) && configuration_.gravity_compensated;
    motor_torque_[i] =
        (unsaid ? 0.0 : effort[i] - bias_[i]) + (unsaid || !configuration_.effort.includes_gravity ? gravity_[i] : 0.0);
  }
  return (motor_torque_.array().abs() <= kMostTorque).all();  // not if one is NaN
}

/// The mean of the filtered τ_c since the last sample, from the mean of τ_c itself.
void HumanTorqueObserver::filterMotorTorque(double dt) {
  const double hold = configuration_.effort.timing == "held" ? configuration_.effort.control_period : 0.0;
  const double of_the_later = std::max(0.0, 0.5 * (1.0 - hold / dt));
  work_ = (1.0 - of_the_later) * last_motor_torque_ + of_the_later * motor_torque_;
  if (!following_) torque_filter_.start(work_);
  following_ = true;
  mean_motor_torque_ = torque_filter_.value();
  torque_filter_.advance(dt, work_);
  mean_motor_torque_ = 0.5 * (mean_motor_torque_ + torque_filter_.value());
}

/// p = M q̇ and u = Cᵀ q̇ − g − friction, with Cᵀ q̇ = Ṁ q̇ − C q̇
bool HumanTorqueObserver::findMomentumAndForces() {
  motion_filter_.position(q_);
  dq_ = motion_filter_.velocity();
  const bool found = model_.massMatrix(q_, mass_) && model_.coriolis(q_, dq_, work_) && model_.gravity(q_, gravity_) &&
                     model_.friction(dq_, friction_);
  if (!found) return false;
  momentum_.noalias() = mass_ * dq_;
  forces_ = -gravity_ - work_ - friction_;
  for (Eigen::Index i = 0; i < momentum_.size(); ++i) {
    momentum_[i] += model_.description().joints[static_cast<std::size_t>(i)].motor_inertia * dq_[i];
  }
  return addMassRate();
}

/// Ṁ q̇: the difference of M a little ahead along q̇ and a little behind.
bool HumanTorqueObserver::addMassRate() {
  const double speed = dq_.norm();
  if (speed == 0.0) return true;
  const double interval = kAhead / speed;
  work_ = q_ + interval * dq_;
  if (!model_.massMatrix(work_, mass_ahead_)) return false;
  work_ = q_ - interval * dq_;
  if (!model_.massMatrix(work_, mass_behind_)) return false;
  mass_ahead_ -= mass_behind_;
  forces_.noalias() += (0.5 / interval) * (mass_ahead_ * dq_);
  return true;
}

}  // namespace demo_logger
