#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "demo_logger/robot/robot_model.h"

namespace demo_logger {

/// Mass properties in which inverse dynamics are linear: (m, m c, I) with the six entries xx, xy, xz, yy, yz, zz of the
/// inertia I about the frame's origin, not about the centre of mass.
using LinearInertia = Eigen::Matrix<double, 10, 1>;
constexpr Eigen::Index kWeightParameters = 4;  // m and m c, the first of them

LinearInertia linearInertia(const BodyInertia& body);
/// The mass must not be zero.
BodyInertia bodyInertia(const LinearInertia& parameters);

/// What each of the first `count` parameters of one body, in a frame fixed to it, adds per unit to the joints' torques.
class InertiaRegressor {
 public:
  InertiaRegressor(const RobotDescription& robot, std::size_t joint, const Eigen::Isometry3d& X_joint_frame,
                   Eigen::Index count);

  Eigen::Index count() const { return static_cast<Eigen::Index>(models_.size()); }
  /// Into `columns` (joints x count).
  void evaluate(const Eigen::VectorXd& q, const Eigen::VectorXd& dq, const Eigen::VectorXd& ddq,
                Eigen::Ref<Eigen::MatrixXd> columns);

 private:
  std::vector<RobotModel> models_;  // each with nothing but a unit of one parameter
  Eigen::VectorXd torque_;
};

}  // namespace demo_logger
