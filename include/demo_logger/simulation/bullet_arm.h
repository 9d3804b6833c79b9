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
///   M(q) q̈ + C(q, q̇) q̇ + g(q) = τ − D q̇ − friction + limits
/// Joint limits stop the arm dead; Coulomb friction holds it (stiction); viscous damping D brakes it, stable however
/// large.
/// Each step solves friction and stops of all joints at once and exactly. The links touch neither each other nor a
/// floor. Deterministic: same description, same calls, same bits.
class BulletArm {
 public:
  /// Starts at rest at 0 or the nearest limit. Throws ModelError if the description has no inertia, or if a joint moves
  /// (nearly) nothing, which Bullet would lock without a word.
  explicit BulletArm(const RobotDescription& description);
  ~BulletArm();

  /// Forgets everything before; a reset arm and a new one go on with the same bits. Throws ModelError if a value is not
  /// finite, the size is wrong, or a position is outside its joint's limits.
  void reset(const ArmState& state);
  const ArmState& state() const;

  /// One control period with `torque` [N m or N] held, in `substeps` equal steps of semi-implicit Euler.
  /// `torque` is clamped to nothing here: limits are the controller's. Throws ModelError on a torque that is not
  /// finite or of the wrong size, before anything moves; `duration` [s] must be positive, `substeps` at least 1.
  void step(const Eigen::VectorXd& torque, double duration, int substeps);

  /// What friction and damping added to the joints [N m or N], mean over the last step(): against the motion. A sensor
  /// between motor and link reads motor torque plus this. Zero after reset().
  const Eigen::VectorXd& frictionTorque() const;

  /// X_base_tip as Bullet sees it; for tests against KDL.
  Eigen::Isometry3d tipPose() const;
  /// q̈ at the present state under `torque`, without friction, damping, limits and contacts: the true acceleration for
  /// sensors, and for tests against KDL.
  Eigen::VectorXd acceleration(const Eigen::VectorXd& torque) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace demo_logger
