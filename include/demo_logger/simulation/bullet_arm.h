#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <vector>

#include "demo_logger/robot/attached_links.h"
#include "demo_logger/robot/robot_description.h"

namespace demo_logger {

struct ArmState {
  Eigen::VectorXd q;   // [rad or m]
  Eigen::VectorXd dq;  // [rad/s or m/s]
};

/// A force and a torque upon a link.
struct LinkWrench {
  int joint = -1;                                    // whose link it is; -1: the base, which feels nothing
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   // [m] where the force acts, in that link
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   // [N]
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  // [N m]
  bool in_link_axes = false;                         // true: both turn with the link; false: in base axes
};

/// What the arm can touch, in base axes. Its own links do not touch each other.
struct Surroundings {
  std::optional<double> floor;            // [m] height
  std::vector<CollisionShape> obstacles;  // poses in the base
  double friction = 0.5;                  // Coulomb's coefficient
  std::vector<AttachedLink> links;        // the arm's shapes; a link with a mesh only, and one without, is a rod
  bool empty() const { return !floor && obstacles.empty(); }
};

/// Where an obstacle pushes the arm.
struct Contact {
  int joint = 0;           // of the link that is touched
  Eigen::Vector3d point;   // [m] base axes
  Eigen::Vector3d normal;  // out of the obstacle
  double distance = 0.0;   // [m]; below 0: they overlap
  double force = 0.0;      // [N] along the normal, in the last step
  int obstacle = -1;       // which of the obstacles; -1: the floor
};

enum class Integrator {
  semi_implicit_euler,  // with friction, stops and contacts; first order
  runge_kutta_4,        // for reference: fourth order, torque held, all else anew in each stage; no stops, no contacts,
};                      // and Coulomb friction as F tanh(q̇/v), v the joint's friction_velocity or 0.01

/// The physics of one arm: Bullet's multi-body dynamics in double precision, built from the lumped description.
///   (M(q) + B) q̈ + C(q, q̇) q̇ + g(q) = τ + Jᵀ W − D q̇ − friction + limits + contacts
/// B: motor inertia; W: wrenches upon links. Joint limits stop the arm dead; Coulomb friction holds it (stiction);
/// viscous damping D brakes it, stable however large. Each step solves friction, stops and contacts at once and
/// exactly. Deterministic: same description, same calls, same bits; all that it remembers is its ArmState.
class BulletArm {
 public:
  /// Starts at rest at 0 or the nearest limit. Throws ModelError if the description has no inertia, if a joint moves
  /// (nearly) nothing, which Bullet would lock without a word, or if an obstacle has no size.
  explicit BulletArm(const RobotDescription& description, const Surroundings& surroundings = {},
                     Integrator integrator = Integrator::semi_implicit_euler);
  ~BulletArm();

  /// Forgets everything before; a reset arm and a new one go on with the same bits. Throws ModelError if a value is not
  /// finite, the size is wrong, or a position is outside its joint's limits.
  void reset(const ArmState& state);
  const ArmState& state() const;
  /// As reset(), but goes on with what linkTorque() was, and takes whatever state a step can lead to.
  void restore(const ArmState& state, const Eigen::VectorXd& link_torque);

  /// The same arm in the same state with other masses: a load taken or put down.
  void setDescription(const RobotDescription& description);

  /// One control period with `torque` [N m or N] and `wrenches` held, in `substeps` equal steps.
  /// `torque` is clamped to nothing here: limits are the controller's. Throws ModelError on a torque that is not
  /// finite or of the wrong size, before anything moves; `duration` [s] must be positive, `substeps` at least 1.
  void step(const Eigen::VectorXd& torque, double duration, int substeps, const std::vector<LinkWrench>& wrenches = {});

  /// What friction and damping added to the joints [N m or N], mean over the last step(): against the motion.
  const Eigen::VectorXd& frictionTorque() const;
  /// What a sensor between gears and link reads at the end of the last step() [N m or N]: motor torque and friction,
  /// less what speeds up the motor. Empty after reset().
  const Eigen::VectorXd& linkTorque() const;
  /// In the last step().
  const std::vector<Contact>& contacts() const;

  /// What the links touch or overlap where they are now, the deepest contact of each link and obstacle.
  std::vector<Contact> overlaps() const;

  /// Jᵀ W [N m or N] at the present state.
  Eigen::VectorXd externalTorque(const std::vector<LinkWrench>& wrenches) const;
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
