#include "demo_logger/simulation/bullet_arm.h"

#include <BulletCollision/BroadphaseCollision/btSimpleBroadphase.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/CollisionShapes/btEmptyShape.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "bullet_body.h"
#include "damping_law.h"
#include "demo_logger/trajectory/error.h"

namespace demo_logger {
namespace {

// Stiction of a whole arm creeps 3e-4 rad in 2 s with Bullet's default of 10 sweeps over the joints.
constexpr int kSolverIterations = 50;

const RobotDescription& requireInertia(const RobotDescription& description) {
  if (!description.has_inertia) {
    throw ModelError("robot '" + description.name + "' cannot be simulated: " + description.inertia_fault);
  }
  refuseMasslessJoints(description);
  return description;
}

double nearestToZero(const ArmJoint& joint) { return std::clamp(0.0, joint.lower, joint.upper); }

Eigen::Isometry3d toEigen(const btTransform& transform) {
  const btVector3& p = transform.getOrigin();
  const btQuaternion q = transform.getRotation();
  return Eigen::Translation3d(p.x(), p.y(), p.z()) * Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z()).normalized();
}

/// Bullet's world with one arm in it. Members go in reverse order, the arm's world before what it refers to.
class BulletWorld {
 public:
  explicit BulletWorld(const RobotDescription& description)
      : arm_(makeBulletBody(description)),
        X_lastlink_tip_(description.X_lastlink_tip),
        dispatcher_(&configuration_),
        world_(&dispatcher_, &broadphase_, &solver_, &configuration_) {
    const Eigen::Vector3d& gravity = description.gravity;
    world_.setGravity(btVector3(gravity.x(), gravity.y(), gravity.z()));
    world_.getSolverInfo().m_numIterations = kSolverIterations;
    world_.addMultiBody(arm_.body.get());
    for (int link = -1; link < size(); ++link) addCollider(link);
    for (int i = 0; i < size(); ++i) addConstraints(i, description.joints[static_cast<std::size_t>(i)]);
  }

  ~BulletWorld() {
    for (const auto& constraint : constraints_) world_.removeMultiBodyConstraint(constraint.get());
    for (const auto& collider : colliders_) world_.removeCollisionObject(collider.get());
    world_.removeMultiBody(arm_.body.get());
  }
  BulletWorld(const BulletWorld&) = delete;
  BulletWorld& operator=(const BulletWorld&) = delete;

  int size() const { return arm_.body->getNumLinks(); }

  void place(const ArmState& state) {
    for (int i = 0; i < size(); ++i) {
      arm_.body->setJointPos(i, state.q[i]);
      arm_.body->setJointVel(i, state.dq[i]);
    }
  }

  void read(ArmState& state) const {
    for (int i = 0; i < size(); ++i) {
      state.q[i] = arm_.body->getJointPos(i);
      state.dq[i] = arm_.body->getJointVel(i);
    }
  }

  /// Coulomb friction is a motor that wants to stand still and is as strong as the friction [N m s per step].
  void setStep(const RobotDescription& description, double step) {
    for (int i = 0; i < size(); ++i) {
      const auto& brake = brakes_[static_cast<std::size_t>(i)];
      if (brake) brake->setMaxAppliedImpulse(description.joints[static_cast<std::size_t>(i)].friction * step);
    }
  }

  /// Joint torques last for one call of stepSimulation only; with 0 internal sub-steps it makes one step of this
  /// length.
  void step(const Eigen::VectorXd& torque, double step) {
    for (int i = 0; i < size(); ++i) arm_.body->addJointTorque(i, torque[i]);
    world_.stepSimulation(step, /*maxSubSteps=*/0);
  }

  /// Impulse [N m s or N s] of Coulomb friction at joint i in the last step.
  double frictionImpulse(int i) const {
    const auto& brake = brakes_[static_cast<std::size_t>(i)];
    return brake ? brake->getAppliedImpulse(0) : 0.0;
  }

  /// Bullet refreshes the links' poses lazily, one step late: ask for fresh ones.
  Eigen::Isometry3d tipPose() {
    arm_.body->forwardKinematics(scratch_rotations_, scratch_vectors_);
    const Eigen::Isometry3d X_base_principal = toEigen(arm_.body->getLink(size() - 1).m_cachedWorldTransform);
    return X_base_principal * arm_.X_link_principal.back().inverse() * X_lastlink_tip_;
  }

  void acceleration(const Eigen::VectorXd& torque, Eigen::VectorXd& result) {
    btMultiBody& body = *arm_.body;
    body.clearForcesAndTorques();
    for (int i = 0; i < size(); ++i) {
      body.addLinkForce(i, world_.getGravity() * body.getLinkMass(i));
      body.addJointTorque(i, torque[i]);
    }
    // A step of no length leaves positions and velocities alone, and the accelerations in the scratch memory behind
    // one number per joint and the base's six.
    body.computeAccelerationsArticulatedBodyAlgorithmMultiDof(/*dt=*/0.0, scratch_numbers_, scratch_vectors_,
                                                              scratch_matrices_, /*isConstraintPass=*/false,
                                                              /*jointFeedbackInWorldSpace=*/false,
                                                              /*jointFeedbackInJointFrame=*/false);
    for (int i = 0; i < size(); ++i) result[i] = scratch_numbers_[body.getNumDofs() + 6 + i];
    body.clearForcesAndTorques();
  }

 private:
  /// Bullet ignores the limits and motors of a link without a collider. These are empty and touch nothing.
  void addCollider(int link) {
    auto collider = std::make_unique<btMultiBodyLinkCollider>(arm_.body.get(), link);
    collider->setCollisionShape(&no_shape_);
    collider->setActivationState(DISABLE_DEACTIVATION);
    if (link < 0) {
      arm_.body->setBaseCollider(collider.get());
    } else {
      arm_.body->getLink(link).m_collider = collider.get();
    }
    world_.addCollisionObject(collider.get(), /*collisionFilterGroup=*/0, /*collisionFilterMask=*/0);
    colliders_.push_back(std::move(collider));
  }

  void addConstraints(int i, const ArmJoint& joint) {
    btMultiBodyJointMotor* brake = nullptr;
    if (joint.friction > 0.0) {
      auto motor = std::make_unique<btMultiBodyJointMotor>(arm_.body.get(), i, /*desiredVelocity=*/0.0,
                                                           /*maxMotorImpulse=*/0.0);
      brake = motor.get();
      addConstraint(std::move(motor));
    }
    brakes_.push_back(brake);
    if (std::isfinite(joint.lower) || std::isfinite(joint.upper)) {
      addConstraint(std::make_unique<btMultiBodyJointLimitConstraint>(arm_.body.get(), i, joint.lower, joint.upper));
    }
  }

  void addConstraint(std::unique_ptr<btMultiBodyConstraint> constraint) {
    world_.addMultiBodyConstraint(constraint.get());
    constraints_.push_back(std::move(constraint));
  }

  BulletBody arm_;
  Eigen::Isometry3d X_lastlink_tip_;
  btEmptyShape no_shape_;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders_;
  std::vector<std::unique_ptr<btMultiBodyConstraint>> constraints_;
  std::vector<btMultiBodyJointMotor*> brakes_;  // one per joint, null without friction
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btSimpleBroadphase broadphase_;
  btMultiBodyConstraintSolver solver_;
  btMultiBodyDynamicsWorld world_;
  btAlignedObjectArray<btScalar> scratch_numbers_;
  btAlignedObjectArray<btVector3> scratch_vectors_;
  btAlignedObjectArray<btMatrix3x3> scratch_matrices_;
  btAlignedObjectArray<btQuaternion> scratch_rotations_;
};

}  // namespace

class BulletArm::Implementation {
 public:
  explicit Implementation(const RobotDescription& given)
      : description(requireInertia(given)), damping(given), size(static_cast<int>(given.joints.size())) {
    Eigen::VectorXd q(size);
    for (int i = 0; i < size; ++i) q[i] = nearestToZero(description.joints[static_cast<std::size_t>(i)]);
    reset({q, Eigen::VectorXd::Zero(size)});
  }

  /// A new world rather than a cleaned one: nothing that Bullet remembers can leak into what comes.
  void reset(const ArmState& given) {
    check("q", given.q);
    check("dq", given.dq);
    state = given;
    friction = Eigen::VectorXd::Zero(size);
    world = std::make_unique<BulletWorld>(description);
    world->place(state);
  }

  void check(const char* what, const Eigen::VectorXd& values) const {
    if (values.size() != size) {
      throw ModelError("simulated robot '" + description.name + "': " + what + " has " + std::to_string(values.size()) +
                       " values, expected one for each of its " + std::to_string(size) + " joints");
    }
    for (int i = 0; i < size; ++i) {
      if (std::isfinite(values[i])) continue;
      throw ModelError("simulated robot '" + description.name + "': " + what + " of joint '" +
                       description.joints[static_cast<std::size_t>(i)].name + "' is " + std::to_string(values[i]) +
                       ", expected a finite number");
    }
  }

  RobotDescription description;
  DampingLaw damping;
  int size;
  ArmState state;
  Eigen::VectorXd friction;
  Eigen::VectorXd total_torque;
  std::unique_ptr<BulletWorld> world;
};

BulletArm::BulletArm(const RobotDescription& description)
    : implementation_(std::make_unique<Implementation>(description)) {}
BulletArm::~BulletArm() = default;

void BulletArm::reset(const ArmState& state) { implementation_->reset(state); }

const ArmState& BulletArm::state() const { return implementation_->state; }

void BulletArm::step(const Eigen::VectorXd& torque, double duration, int substeps) {
  Implementation& own = *implementation_;
  own.check("torque", torque);
  if (!(duration > 0.0) || !std::isfinite(duration) || substeps < 1) {
    throw ModelError("simulated robot '" + own.description.name + "': a step of " + std::to_string(duration) +
                     " s in " + std::to_string(substeps) + " parts, expected a positive time and at least one part");
  }
  const double step = duration / substeps;
  own.world->setStep(own.description, step);
  own.damping.update(own.state.q, step);
  own.friction.setZero();
  for (int substep = 0; substep < substeps; ++substep) {
    own.total_torque = torque;
    own.damping.addTo(own.total_torque, own.state.dq);
    own.friction += own.total_torque - torque;
    own.world->step(own.total_torque, step);
    own.world->read(own.state);
    for (int i = 0; i < own.size; ++i) own.friction[i] += own.world->frictionImpulse(i) / step;
  }
  own.friction /= substeps;
}

const Eigen::VectorXd& BulletArm::frictionTorque() const { return implementation_->friction; }

Eigen::Isometry3d BulletArm::tipPose() const { return implementation_->world->tipPose(); }

Eigen::VectorXd BulletArm::acceleration(const Eigen::VectorXd& torque) const {
  const Implementation& own = *implementation_;
  own.check("torque", torque);
  Eigen::VectorXd result(own.size);
  own.world->acceleration(torque, result);
  return result;
}

}  // namespace demo_logger
