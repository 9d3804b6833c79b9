#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>

#include "demo_logger/robot/robot_description.h"

namespace demo_logger {

/// Kinematics and dynamics of one arm, by KDL on the lumped description. n joints, order of RobotDescription::joints;
/// frames: base and tip; SI units.
///   M(q) q̈ + C(q, q̇) q̇ + g(q) = τ          (no friction, no motor inertia: those are the arm's, not the chain's)
/// Each object owns its chain and its work space: use one per thread. Throws ModelError if a vector is not of size n,
/// or dynamics are asked of an arm without inertia. Input must be finite; NaN in gives NaN out.
class RobotModel {
 public:
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
  /// M(q) q̈ + C(q, q̇) q̇ + g(q)
  Eigen::VectorXd inverseDynamics(const Eigen::VectorXd& q, const Eigen::VectorXd& dq,
                                  const Eigen::VectorXd& ddq) const;

  /// The same into a result of the caller's, resized if need be: no allocation in a control loop.
  void jacobian(const Eigen::VectorXd& q, Eigen::MatrixXd& result) const;
  void gravity(const Eigen::VectorXd& q, Eigen::VectorXd& result) const;
  void massMatrix(const Eigen::VectorXd& q, Eigen::MatrixXd& result) const;
  void coriolis(const Eigen::VectorXd& q, const Eigen::VectorXd& dq, Eigen::VectorXd& result) const;
  void inverseDynamics(const Eigen::VectorXd& q, const Eigen::VectorXd& dq, const Eigen::VectorXd& ddq,
                       Eigen::VectorXd& result) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace demo_logger
