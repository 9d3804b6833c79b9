#pragma once

#include <Eigen/Core>
#include <vector>

#include "demo_logger/robot/robot_description.h"

namespace demo_logger {

/// More moving joints in one chain than any arm has; work space of this size lives on the stack.
constexpr int kMostJoints = 32;

using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostJoints, 1>;
using JacobianMatrix = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMostJoints>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

struct RigidPose {
  Eigen::Matrix3d R;
  Eigen::Vector3d p;  // [m]
};

/// Forward kinematics and Jacobian for the inner loop of the inverse kinematics, several times faster than KDL's
/// solvers on the same chain and equal to them to rounding. Every joint frame is turned so that its joint moves about
/// or along z: then a joint costs one product with a constant matrix and one rotation of two columns. Frames and units
/// as in RobotModel. Nothing changes after construction, so one object serves any number of threads.
class ArmKinematics {
 public:
  /// Throws ModelError for more than kMostJoints joints.
  explicit ArmKinematics(const RobotDescription& robot);

  int size() const { return static_cast<int>(joints_.size()); }
  bool isPrismatic(int joint) const { return joints_[static_cast<std::size_t>(joint)].prismatic; }
  /// [m] no tip position is further than this from the first joint's origin.
  double reach() const { return reach_; }
  const Eigen::Vector3d& firstOrigin() const { return joints_.front().p; }

  /// X_base_tip(q)
  void forward(const JointVector& q, RigidPose& X_base_tip) const;
  /// The same with the 6 x n Jacobian: velocity of the tip's origin, then ω, in base axes, per joint velocity.
  void forward(const JointVector& q, RigidPose& X_base_tip, JacobianMatrix& jacobian) const;

 private:
  struct Joint {
    Eigen::Matrix3d R;  // from the previous joint's turned frame to this one's, at q = 0
    Eigen::Vector3d p;
    bool prismatic;
  };

  std::vector<Joint> joints_;
  RigidPose X_last_tip_;
  double reach_ = 0.0;
};

}  // namespace demo_logger
