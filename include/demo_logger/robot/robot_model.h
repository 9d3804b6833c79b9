#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>

#include "demo_logger/robot/robot_description.h"

namespace demo_logger {

/// What the surroundings do to the tip: a force [N] at its origin and a torque [N m], both in base axes, as the rows of
/// the Jacobian count. A hand that lifts the tool has force.z() > 0.
struct TipWrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
};

/// Kinematics and dynamics of one arm, by KDL on the lumped description. n joints, order of RobotDescription::joints;
/// frames: base and tip; SI units.
///   M(q) q̈ + C(q, q̇) q̇ + g(q) = τ + J(q)ᵀ W        τ at the joints, W at the tip
///   τ_motor = τ + B q̈ + D q̇ + F tanh(q̇ / v)          motor inertia, viscous and Coulomb friction of the drives
/// Each object owns its chain and its work space. Threads may share one: calls take turns; give each its own for speed.
/// After construction nothing is allocated if the caller's results have their size.
/// A result is finite or is said to be none. Where a value is returned, ModelError names the joint whose value is not
/// finite, or says that the result overflows. Where the result is the caller's, the call returns false then, and the
/// result is NaN: a control loop need not catch. Either throws ModelError if a vector is not of size n, or dynamics are
/// asked of an arm without inertia.
class RobotModel {
 public:
  /// Throws ModelError if the description has no joint.
  explicit RobotModel(RobotDescription description);
  ~RobotModel();
  RobotModel(RobotModel&&) noexcept;
  RobotModel& operator=(RobotModel&&) noexcept;

  const RobotDescription& description() const;
  int size() const;  // n

  /// X_base_tip(q)
  Eigen::Isometry3d forwardKinematics(const Eigen::VectorXd& q) const;
  /// 6 x n: tip velocity (v of the tip's origin, ω), both in base axes, per joint velocity.
  Eigen::MatrixXd jacobian(const Eigen::VectorXd& q) const;

  /// g(q), the torque that holds the arm still
  Eigen::VectorXd gravity(const Eigen::VectorXd& q) const;
  Eigen::MatrixXd massMatrix(const Eigen::VectorXd& q) const;
  /// C(q, q̇) q̇
  Eigen::VectorXd coriolis(const Eigen::VectorXd& q, const Eigen::VectorXd& dq) const;
  /// τ = M(q) q̈ + C(q, q̇) q̇ + g(q) − J(q)ᵀ W
  Eigen::VectorXd inverseDynamics(const Eigen::VectorXd& q, const Eigen::VectorXd& dq, const Eigen::VectorXd& ddq,
                                  const TipWrench& wrench = {}) const;
  /// D q̇ + F tanh(q̇ / v): what the drives lose
  Eigen::VectorXd friction(const Eigen::VectorXd& dq) const;
  /// The whole model: inverse dynamics, motor inertia and friction.
  Eigen::VectorXd motorTorque(const Eigen::VectorXd& q, const Eigen::VectorXd& dq, const Eigen::VectorXd& ddq,
                              const TipWrench& wrench = {}) const;

  /// The same into a result of the caller's, resized if need be.
  bool forwardKinematics(const Eigen::VectorXd& q, Eigen::Isometry3d& result) const;
  bool jacobian(const Eigen::VectorXd& q, Eigen::MatrixXd& result) const;
  bool gravity(const Eigen::VectorXd& q, Eigen::VectorXd& result) const;
  bool massMatrix(const Eigen::VectorXd& q, Eigen::MatrixXd& result) const;
  bool coriolis(const Eigen::VectorXd& q, const Eigen::VectorXd& dq, Eigen::VectorXd& result) const;
  bool inverseDynamics(const Eigen::VectorXd& q, const Eigen::VectorXd& dq, const Eigen::VectorXd& ddq,
                       Eigen::VectorXd& result) const;
  bool inverseDynamics(const Eigen::VectorXd& q, const Eigen::VectorXd& dq, const Eigen::VectorXd& ddq,
                       const TipWrench& wrench, Eigen::VectorXd& result) const;
  bool friction(const Eigen::VectorXd& dq, Eigen::VectorXd& result) const;
  bool motorTorque(const Eigen::VectorXd& q, const Eigen::VectorXd& dq, const Eigen::VectorXd& ddq,
                   Eigen::VectorXd& result) const;
  bool motorTorque(const Eigen::VectorXd& q, const Eigen::VectorXd& dq, const Eigen::VectorXd& ddq,
                   const TipWrench& wrench, Eigen::VectorXd& result) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace demo_logger
