#include "demo_logger/simulation/bullet_arm.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "arm_dynamics.h"
#include "bullet_body.h"
#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/print.h"

namespace demo_logger {
namespace {

const RobotDescription& requireInertia(const RobotDescription& description) {
  if (!description.has_inertia) {
    throw ModelError("robot '" + description.name + "' cannot be simulated: " + description.inertia_fault);
  }
  refuseMasslessJoints(description);
  return description;
}

double nearestToZero(const ArmJoint& joint) { return std::clamp(0.0, joint.lower, joint.upper); }

}  // namespace

class BulletArm::Implementation {
 public:
  Implementation(const RobotDescription& given, const Surroundings& around, Integrator how)
      : description(requireInertia(given)),
        surroundings(around),
        integrator(how),
        size(static_cast<int>(given.joints.size())),
        dynamics(std::make_unique<ArmDynamics>(description, surroundings)) {
    Eigen::VectorXd q(size);
    for (int i = 0; i < size; ++i) q[i] = nearestToZero(description.joints[static_cast<std::size_t>(i)]);
    reset({q, Eigen::VectorXd::Zero(size)});
  }

  void reset(const ArmState& given) {
    check("q", given.q);
    check("dq", given.dq);
    checkLimits(given.q);
    state = given;
    friction = Eigen::VectorXd::Zero(size);
    link_torque.resize(0);
    contacts.clear();
  }

  void check(const char* what, const Eigen::VectorXd& values) const {
    if (values.size() != size) {
      throw ModelError("simulated robot '" + description.name + "': " + what + " has " + std::to_string(values.size()) +
                       " values, expected one for each of its " + std::to_string(size) + " joints");
    }
    for (int i = 0; i < size; ++i) {
      if (std::isfinite(values[i])) continue;
      throw ModelError("simulated robot '" + description.name + "': " + what + " of joint '" +
                       description.joints[static_cast<std::size_t>(i)].name + "' is " + print(values[i]) +
                       ", expected a finite number");
    }
  }

  /// Bullet would throw an arm from far outside back inside within a step or two.
  void checkLimits(const Eigen::VectorXd& q) const {
    constexpr double kOvershoot = 0.05;  // [rad or m] more than a stopped arm leans into its limit
    for (int i = 0; i < size; ++i) {
      const ArmJoint& joint = description.joints[static_cast<std::size_t>(i)];
      if (q[i] >= joint.lower - kOvershoot && q[i] <= joint.upper + kOvershoot) continue;
      std::ostringstream sentence;
      sentence << "simulated robot '" << description.name << "': joint '" << joint.name << "' cannot start at " << q[i]
               << (joint.type == JointType::prismatic ? " m" : " rad") << ", expected a position from " << joint.lower
               << " to " << joint.upper;
      throw ModelError(sentence.str());
    }
  }

  RobotDescription description;
  Surroundings surroundings;
  Integrator integrator;
  int size;
  std::unique_ptr<ArmDynamics> dynamics;
  ArmState state;
  Eigen::VectorXd friction;
  Eigen::VectorXd link_torque;
  std::vector<Contact> contacts;
};

BulletArm::BulletArm(const RobotDescription& description, const Surroundings& surroundings, Integrator integrator)
    : implementation_(std::make_unique<Implementation>(description, surroundings, integrator)) {}
BulletArm::~BulletArm() = default;

void BulletArm::reset(const ArmState& state) { implementation_->reset(state); }

void BulletArm::restore(const ArmState& state, const Eigen::VectorXd& link_torque) {
  Implementation& own = *implementation_;
  own.check("q", state.q);
  own.check("dq", state.dq);
  own.checkLimits(state.q);
  if (link_torque.size() != 0) own.check("link torque", link_torque);
  own.state = state;
  own.friction.setZero();
  own.link_torque = link_torque;
  own.contacts.clear();
}

const ArmState& BulletArm::state() const { return implementation_->state; }

void BulletArm::setDescription(const RobotDescription& description) {
  Implementation& own = *implementation_;
  requireInertia(description);
  own.description = description;
  own.dynamics = std::make_unique<ArmDynamics>(description, own.surroundings);
}

void BulletArm::step(const Eigen::VectorXd& torque, double duration, int substeps,
                     const std::vector<LinkWrench>& wrenches) {
  Implementation& own = *implementation_;
  own.check("torque", torque);
  if (!(duration > 0.0) || !std::isfinite(duration) || substeps < 1) {
    throw ModelError("simulated robot '" + own.description.name + "': a step of " + print(duration) + " s in " +
                     std::to_string(substeps) + " parts, expected a positive time and at least one part");
  }
  const double step = duration / substeps;
  own.friction.setZero();
  const ArmLoads loads{torque, wrenches};
  for (int substep = 0; substep < substeps; ++substep) {
    if (own.integrator == Integrator::runge_kutta_4) {
      own.dynamics->stepRungeKutta(own.state, loads, step);
    } else {
      own.dynamics->stepEuler(own.state, loads, step);
    }
    own.friction += own.dynamics->frictionImpulse();
  }
  own.friction /= duration;
  own.link_torque = own.dynamics->linkTorque();
  own.contacts = own.dynamics->contacts();
}

const Eigen::VectorXd& BulletArm::linkTorque() const { return implementation_->link_torque; }

const std::vector<Contact>& BulletArm::contacts() const { return implementation_->contacts; }

std::vector<Contact> BulletArm::overlaps() const {
  return implementation_->dynamics->overlaps(implementation_->state.q);
}

Eigen::VectorXd BulletArm::externalTorque(const std::vector<LinkWrench>& wrenches) const {
  return implementation_->dynamics->externalTorque(implementation_->state.q, wrenches);
}

const Eigen::VectorXd& BulletArm::frictionTorque() const { return implementation_->friction; }

Eigen::Isometry3d BulletArm::tipPose() const { return implementation_->dynamics->tipPose(implementation_->state.q); }

Eigen::VectorXd BulletArm::acceleration(const Eigen::VectorXd& torque) const {
  Implementation& own = *implementation_;
  own.check("torque", torque);
  return own.dynamics->acceleration(own.state, torque);
}

}  // namespace demo_logger
