#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>

#include "demo_logger/robot/robot_description.h"

namespace demo_logger {

struct ArmState {
  Eigen::VectorXd q;   // [rad or m]
  Eigen::VectorXd dq;  // [rad/s or m/s]
};

/// The physics of one arm: Bullet's multi-body dynamics in double precision, built from the lumped description.
/// Joint limits stop the arm; Coulomb friction holds it (stiction); viscous damping brakes it. Deterministic.
class BulletArm {
 public:
  /// Throws ModelError if the description has no inertia, or a joint moves (nearly) nothing.
  explicit BulletArm(const RobotDescription& description);
  ~BulletArm();

  void reset(const ArmState& state);
  const ArmState& state() const;

  /// One control period with `torque` [N m or N] held, in `substeps` equal steps of Bullet's semi-implicit Euler.
  /// `torque` is clamped to nothing here: limits are the controller's.
  void step(const Eigen::VectorXd& torque, double duration, int substeps);

  /// X_base_tip as Bullet sees it; for tests against KDL.
  Eigen::Isometry3d tipPose() const;
  /// q̈ at the present state under `torque`, without friction, damping and contacts; for tests against KDL.
  Eigen::VectorXd acceleration(const Eigen::VectorXd& torque) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace demo_logger
