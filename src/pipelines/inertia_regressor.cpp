#include "inertia_regressor.h"

#include <utility>

namespace demo_logger {
namespace {

using Index = Eigen::Index;

constexpr std::pair<Index, Index> kEntries[] = {{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}};

/// Steiner's term for a mass at offset c: m (|c|² 1 − c cᵀ).
Eigen::Matrix3d pointInertia(double mass, const Eigen::Vector3d& c) {
  return mass * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
}

/// A unit of one parameter; those of m c come with a unit of mass, since a centre needs one.
BodyInertia unitOf(Index parameter) {
  LinearInertia unit = LinearInertia::Zero();
  unit[parameter] = 1.0;
  if (parameter < kWeightParameters) {
    unit[0] = 1.0;
    return bodyInertia(unit);
  }
  BodyInertia body;
  const auto [row, column] = kEntries[parameter - kWeightParameters];
  body.inertia(row, column) = body.inertia(column, row) = 1.0;
  return body;
}

}  // namespace

LinearInertia linearInertia(const BodyInertia& body) {
  LinearInertia parameters;
  const Eigen::Matrix3d about_origin = body.inertia + pointInertia(body.mass, body.center);
  parameters[0] = body.mass;
  parameters.segment<3>(1) = body.mass * body.center;
  for (Index i = 0; i < 6; ++i) {
    parameters[kWeightParameters + i] = about_origin(kEntries[i].first, kEntries[i].second);
  }
  return parameters;
}

BodyInertia bodyInertia(const LinearInertia& parameters) {
  BodyInertia body;
  body.mass = parameters[0];
  body.center = parameters.segment<3>(1) / body.mass;
  for (Index i = 0; i < 6; ++i) {
    const auto [row, column] = kEntries[i];
    body.inertia(row, column) = body.inertia(column, row) = parameters[kWeightParameters + i];
  }
  body.inertia -= pointInertia(body.mass, body.center);
  return body;
}

InertiaRegressor::InertiaRegressor(const RobotDescription& robot, std::size_t joint,
                                   const Eigen::Isometry3d& X_joint_frame, Index count) {
  RobotDescription bare = robot;
  for (ArmJoint& other : bare.joints) other.body = {};
  const Eigen::Matrix3d R = X_joint_frame.linear();
  for (Index parameter = 0; parameter < count; ++parameter) {
    const BodyInertia unit = unitOf(parameter);
    bare.joints[joint].body = {unit.mass, X_joint_frame * unit.center, R * unit.inertia * R.transpose()};
    models_.emplace_back(bare);
  }
}

void InertiaRegressor::evaluate(const Eigen::VectorXd& q, const Eigen::VectorXd& dq, const Eigen::VectorXd& ddq,
                                Eigen::Ref<Eigen::MatrixXd> columns) {
  for (Index parameter = 0; parameter < count(); ++parameter) {
    models_[static_cast<std::size_t>(parameter)].inverseDynamics(q, dq, ddq, torque_);
    columns.col(parameter) = torque_;
  }
  for (Index parameter = 1; parameter < std::min(count(), kWeightParameters); ++parameter) {
    columns.col(parameter) -= columns.col(0);
  }
}

}  // namespace demo_logger
