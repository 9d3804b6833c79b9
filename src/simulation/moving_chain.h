#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "demo_logger/robot/robot_description.h"

namespace demo_logger {

/// Where the links of an arm are and what its joints feel of their masses, for the innermost loop of the simulation:
/// everything in base axes, so that composite bodies are plain sums. KDL gives the same numbers (tested), slower.
class MovingChain {
 public:
  explicit MovingChain(const RobotDescription& description);

  int size() const { return static_cast<int>(bodies_.size()); }

  /// Everything below is for these joint positions.
  void place(const Eigen::VectorXd& q);

  /// X_base_link of the link that joint `i` moves; the base's own for -1.
  const Eigen::Isometry3d& pose(int i) const { return i < 0 ? base_ : bodies_[static_cast<std::size_t>(i)].pose; }

  /// M(q), without motor inertia.
  const Eigen::MatrixXd& massMatrix();

  /// Velocity per velocity of joint `i` of `point`, which moves with that joint's link or one beyond it; base axes.
  Eigen::Vector3d pointVelocity(int i, const Eigen::Vector3d& point) const;
  /// Angular velocity likewise.
  Eigen::Vector3d angularVelocity(int i) const;

 private:
  struct Body {
    Eigen::Isometry3d X_parent_joint;
    Eigen::Vector3d axis_in_joint;
    bool slides;
    double mass;
    Eigen::Vector3d center_in_link;
    Eigen::Matrix3d inertia_in_link;
    // For the present positions, in base axes:
    Eigen::Isometry3d pose;
    Eigen::Vector3d axis;
  };

  Eigen::Isometry3d base_ = Eigen::Isometry3d::Identity();
  std::vector<Body> bodies_;
  Eigen::MatrixXd mass_;
};

}  // namespace demo_logger
