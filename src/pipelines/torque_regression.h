#pragma once

#include <Eigen/Core>
#include <vector>

#include "ridge_regression.h"

namespace demo_logger {

/// Linear equations for an arm's parameters, several for each row: of joint i in row k
///   unexplained(k, i) = inertial columns · θ_inertial + bias_i + q̇ damping_i + sign friction_i
/// θ is θ_inertial, then bias, damping, friction of each joint.
struct TorqueRegression {
  Eigen::Index joints = 0;
  Eigen::MatrixXd inertial;                                 // (rows · joints) x parameters, row k · joints + i
  Eigen::MatrixXd unexplained;                              // rows x joints; NaN: not known
  Eigen::MatrixXd velocity;                                 // rows x joints
  Eigen::MatrixXd sign;                                     // of the velocity, as friction feels it
  Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> says;  // rows x joints: the equation holds

  static constexpr Eigen::Index kOfJoint = 3;  // bias, damping, friction
  static constexpr Eigen::Index kBias = 0;
  static constexpr Eigen::Index kDamping = 1;
  static constexpr Eigen::Index kFriction = 2;

  Eigen::Index rows() const { return unexplained.rows(); }
  Eigen::Index parameters() const { return inertial.cols() + kOfJoint * joints; }
  Eigen::Index indexOf(Eigen::Index joint, Eigen::Index which) const {
    return inertial.cols() + kOfJoint * joint + which;
  }
  double residual(Eigen::Index row, Eigen::Index joint, const Eigen::VectorXd& theta) const;
};

/// Sums over some of one joint's equations: x = (inertial columns, 1, q̇, sign), and y.
struct JointSums {
  Eigen::MatrixXd xx;
  Eigen::VectorXd xy;
  double yy = 0.0;
  double count = 0.0;

  JointSums() = default;
  explicit JointSums(Eigen::Index inertial);
  void add(const TorqueRegression& regression, Eigen::Index row, Eigen::Index joint);
  JointSums& operator+=(const JointSums& other);
  /// Σ (y − x θ)² for the θ of all joints.
  double squares(const TorqueRegression& regression, Eigen::Index joint, const Eigen::VectorXd& theta) const;
};

/// A and b of solveRidge from sums for each joint, with the weight of each joint's equations.
RidgeEstimate solveRegression(const TorqueRegression& regression, const std::vector<JointSums>& sums,
                              const Eigen::VectorXd& weight, const Prior& prior);

}  // namespace demo_logger
