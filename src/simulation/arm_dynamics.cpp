#include "arm_dynamics.h"

#include <algorithm>
#include <cmath>

namespace demo_logger {
namespace {

template <typename Field>
Eigen::VectorXd eachJoint(const RobotDescription& description, Field field) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(description.joints.size()));
  for (std::size_t i = 0; i < description.joints.size(); ++i) {
    values[static_cast<Eigen::Index>(i)] = field(description.joints[i]);
  }
  return values;
}

double frictionVelocity(const ArmJoint& joint) {
  constexpr double kUsual = 0.01;  // [rad/s or m/s]
  return joint.friction_velocity > 0.0 ? joint.friction_velocity : kUsual;
}

}  // namespace

ArmDynamics::ArmDynamics(const RobotDescription& description, const Surroundings& surroundings)
    : bullet_(description),
      chain_(description),
      joints_(description.joints),
      finder_(description, surroundings),
      contact_friction_(surroundings.friction),
      damping_(eachJoint(description, [](const ArmJoint& joint) { return joint.damping; })),
      motor_inertia_(eachJoint(description, [](const ArmJoint& joint) { return joint.motor_inertia; })),
      coulomb_(eachJoint(description, [](const ArmJoint& joint) { return joint.friction; })),
      coulomb_velocity_(eachJoint(description, frictionVelocity)),
      bare_(damping_.isZero(0.0) && motor_inertia_.isZero(0.0)),
      friction_impulse_(Eigen::VectorXd::Zero(chain_.size())),
      direction_(chain_.size()),
      inverse_(chain_.size(), chain_.size()) {}

void ArmDynamics::stepEuler(ArmState& state, const ArmLoads& loads, double step) {
  before_ = state.dq;
  total_ = loads.torque;
  const bool placed = !loads.wrenches.empty() || !finder_.empty();
  if (placed) chain_.place(state.q);
  addExternalTorque(loads.wrenches, total_);
  bullet_.acceleration(state, total_, acceleration_);
  problem_.clear();
  joints_.addTo(problem_, state, step);
  contacts_.clear();
  if (!finder_.empty()) {
    finder_.find(chain_, contacts_);
    addContactRows(step);
  }
  friction_impulse_.setZero();
  state.dq += step * acceleration_;
  if (!bare_ || problem_.rows() > 0) {
    if (!placed) chain_.place(state.q);
    applyConstraints(state, step);
  }
  state.q += step * state.dq;
  link_torque_ = loads.torque + (friction_impulse_ - motor_inertia_.cwiseProduct(state.dq - before_)) / step;
}

/// From the velocity of the bare arm to that with motors, damping and all constraints.
void ArmDynamics::applyConstraints(ArmState& state, double step) {
  inertia_ = chain_.massMatrix();
  Eigen::VectorXd& momentum = acceleration_;
  momentum.noalias() = inertia_ * state.dq;
  momentum += motor_inertia_.cwiseProduct(before_);
  inertia_.diagonal() += motor_inertia_ + step * damping_;
  factors_.compute(inertia_);
  if (!bare_) state.dq = factors_.solve(momentum);
  if (problem_.rows() > 0) {
    inverse_.setIdentity();
    factors_.solveInPlace(inverse_);
    problem_.solve(inverse_, state.dq);
    joints_.addFrictionImpulse(problem_, friction_impulse_);
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      if (contact_rows_[i] >= 0) contacts_[i].force = problem_.impulse(contact_rows_[i]) / step;
    }
  }
  friction_impulse_ -= step * damping_.cwiseProduct(state.dq);
}

/// Like a joint's stop: a link may come just to the obstacle within the step, and one inside comes out slowly.
void ArmDynamics::addContactRows(double step) {
  constexpr double kWayOut = 0.1;     // [m/s]
  constexpr double kStrongest = 1e9;  // [N s]
  constexpr double kSoftness = 1e-4;  // of the row's own: several points carry one body, so they must share
  constexpr double kMovable = 1e-9;   // [m/rad] less is no way out for the link
  contact_rows_.clear();
  for (const Contact& contact : contacts_) {
    Eigen::Matrix3Xd jacobian = Eigen::Matrix3Xd::Zero(3, chain_.size());
    for (int i = 0; i <= contact.joint; ++i) jacobian.col(i) = chain_.pointVelocity(i, contact.point);
    direction_ = jacobian.transpose() * contact.normal;
    if (direction_.cwiseAbs().maxCoeff() < kMovable) {
      contact_rows_.push_back(-1);
      continue;
    }
    const int normal =
        problem_.add(direction_, -std::max(contact.distance / step, -kWayOut), 0.0, kStrongest, kSoftness);
    contact_rows_.push_back(normal);
    const Eigen::Vector3d along = contact.normal.unitOrthogonal();
    for (const Eigen::Vector3d& tangent : {along, Eigen::Vector3d(contact.normal.cross(along))}) {
      direction_ = jacobian.transpose() * tangent;
      problem_.addSliding(direction_, contact_friction_, normal, kSoftness);
    }
  }
}

/// Torque of the wrenches at the placed chain.
void ArmDynamics::addExternalTorque(const std::vector<LinkWrench>& wrenches, Eigen::VectorXd& torque) const {
  for (const LinkWrench& wrench : wrenches) {
    if (wrench.joint < 0) continue;
    const Eigen::Isometry3d& X_base_link = chain_.pose(wrench.joint);
    const Eigen::Vector3d point = X_base_link * wrench.point;
    Eigen::Vector3d force = wrench.force;
    Eigen::Vector3d moment = wrench.torque;
    if (wrench.in_link_axes) {
      force = X_base_link.linear() * force;
      moment = X_base_link.linear() * moment;
    }
    for (int i = 0; i <= wrench.joint; ++i) {
      torque[i] += chain_.pointVelocity(i, point).dot(force) + chain_.angularVelocity(i).dot(moment);
    }
  }
}

std::vector<Contact> ArmDynamics::overlaps(const Eigen::VectorXd& q) {
  chain_.place(q);
  return finder_.overlaps(chain_);
}

Eigen::VectorXd ArmDynamics::externalTorque(const Eigen::VectorXd& q, const std::vector<LinkWrench>& wrenches) {
  Eigen::VectorXd torque = Eigen::VectorXd::Zero(chain_.size());
  chain_.place(q);
  addExternalTorque(wrenches, torque);
  return torque;
}

Eigen::VectorXd ArmDynamics::acceleration(const ArmState& state, const Eigen::VectorXd& torque) {
  Eigen::VectorXd result;
  bullet_.acceleration(state, torque, result);
  if (motor_inertia_.isZero(0.0)) return result;
  chain_.place(state.q);
  inertia_ = chain_.massMatrix();
  result = inertia_ * result;
  inertia_.diagonal() += motor_inertia_;
  return factors_.compute(inertia_).solve(result);
}

/// −D q̇ − F tanh(q̇/v)
Eigen::VectorXd ArmDynamics::smoothFriction(const Eigen::VectorXd& dq) const {
  Eigen::VectorXd torque = -damping_.cwiseProduct(dq);
  for (Eigen::Index i = 0; i < dq.size(); ++i) torque[i] -= coulomb_[i] * std::tanh(dq[i] / coulomb_velocity_[i]);
  return torque;
}

Eigen::VectorXd ArmDynamics::smoothAcceleration(const ArmState& state, const ArmLoads& loads) {
  total_ = loads.torque + smoothFriction(state.dq);
  if (!loads.wrenches.empty()) {
    chain_.place(state.q);
    addExternalTorque(loads.wrenches, total_);
  }
  return acceleration(state, total_);
}

void ArmDynamics::stepRungeKutta(ArmState& state, const ArmLoads& loads, double step) {
  const ArmState start = state;
  ArmState stage = start;
  ArmState slope{Eigen::VectorXd::Zero(chain_.size()), Eigen::VectorXd::Zero(chain_.size())};  // weighted mean
  friction_impulse_.setZero();
  constexpr double kNodes[] = {0.5, 0.5, 1.0, 0.0};
  constexpr double kWeights[] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
  for (int i = 0; i < 4; ++i) {
    const Eigen::VectorXd dq = stage.dq;
    const Eigen::VectorXd ddq = smoothAcceleration(stage, loads);
    slope.q += kWeights[i] * dq;
    slope.dq += kWeights[i] * ddq;
    friction_impulse_ += kWeights[i] * step * smoothFriction(dq);
    stage.q = start.q + kNodes[i] * step * dq;
    stage.dq = start.dq + kNodes[i] * step * ddq;
  }
  state.q += step * slope.q;
  state.dq += step * slope.dq;
  contacts_.clear();
  link_torque_ = loads.torque + (friction_impulse_ - motor_inertia_.cwiseProduct(state.dq - start.dq)) / step;
}

}  // namespace demo_logger
