#include "demo_logger/robot/robot_model.h"

#include <cmath>
#include <initializer_list>
#include <kdl/chaindynparam.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainidsolver_recursive_newton_euler.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <mutex>
#include <sstream>
#include <string>
#include <utility>

#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/not_a_number.h"
#include "kdl_chain.h"

namespace demo_logger {
namespace {

RobotDescription withJoints(RobotDescription description) {
  if (description.joints.empty()) throw ModelError("robot '" + description.name + "' has no joint to move");
  return description;
}

/// What a caller gave, for the sentence that refuses it.
struct Given {
  const char* symbol;
  const char* quantity;
  const char* per;  // of the unit
  const Eigen::VectorXd& values;
};

Given position(const Eigen::VectorXd& q) { return {"q", "position", "", q}; }
Given velocity(const Eigen::VectorXd& dq) { return {"dq", "velocity", "/s", dq}; }
Given acceleration(const Eigen::VectorXd& ddq) { return {"ddq", "acceleration", "/s²", ddq}; }

}  // namespace

/// Chain, solvers and work space stay together here, and never move: the solvers refer to the chain.
class RobotModel::Implementation {
 public:
  explicit Implementation(RobotDescription given)
      : description(withJoints(std::move(given))),
        chain(makeKdlChain(description)),
        kinematics(chain),
        jacobian(chain),
        dynamics(chain, toKdl(description.gravity)),
        inverse_dynamics(chain, toKdl(description.gravity)),
        q(chain.getNrOfJoints()),
        dq(q),
        ddq(q),
        torque(q),
        twists(chain.getNrOfJoints()),
        mass(size()),
        wrenches(chain.getNrOfSegments(), KDL::Wrench::Zero()) {}

  int size() const { return static_cast<int>(description.joints.size()); }

  void requireInertia() const {
    if (!description.has_inertia) {
      throw ModelError("no dynamics for robot '" + description.name + "': " + description.inertia_fault);
    }
  }

  void requireSize(const char* symbol, const Eigen::VectorXd& values) const {
    if (values.size() == size()) return;
    throw ModelError("robot '" + description.name + "': " + symbol + " has " + std::to_string(values.size()) +
                     " values, expected one for each of its " + std::to_string(size()) + " joints");
  }

  /// Copies into KDL's vector; false if a value is not finite, which KDL would not report.
  static bool take(const Eigen::VectorXd& values, KDL::JntArray& target) {
    target.data = values;
    return values.allFinite();
  }

  /// Copies what KDL found; false, and NaN, if it found nothing or nothing finite.
  template <typename Found, typename Result>
  static bool give(bool found, const Found& value, Result&& result) {
    if (found && value.allFinite()) {
      result = value;
      return true;
    }
    result = Found::PlainObject::Constant(value.rows(), value.cols(), kNaN);
    return false;
  }

  double frictionOf(Eigen::Index i, double velocity) const {
    const ArmJoint& joint = description.joints[static_cast<std::size_t>(i)];
    const double viscous = joint.damping * velocity;
    if (joint.friction == 0.0 || velocity == 0.0) return viscous;
    return viscous + joint.friction * (joint.friction_velocity > 0.0 ? std::tanh(velocity / joint.friction_velocity)
                                                                     : std::copysign(1.0, velocity));
  }

  /// The wrench that KDL wants: on the last segment, in the axes of the tip.
  bool takeWrench(const TipWrench& wrench) {
    wrenches.back() = KDL::Wrench::Zero();
    if (wrench.force.isZero(0.0) && wrench.torque.isZero(0.0)) return true;
    if (!wrench.force.allFinite() || !wrench.torque.allFinite()) return false;
    KDL::Frame X_base_tip;
    if (kinematics.JntToCart(q, X_base_tip) != KDL::SolverI::E_NOERROR) return false;
    wrenches.back() = X_base_tip.M.Inverse() * KDL::Wrench(toKdl(wrench.force), toKdl(wrench.torque));
    return true;
  }

  bool solveInverseDynamics(const Eigen::VectorXd& given_q, const Eigen::VectorXd& given_dq,
                            const Eigen::VectorXd& given_ddq, const TipWrench& wrench) {
    requireInertia();
    requireSize("q", given_q);
    requireSize("dq", given_dq);
    requireSize("ddq", given_ddq);
    return take(given_q, q) && take(given_dq, dq) && take(given_ddq, ddq) && takeWrench(wrench) &&
           inverse_dynamics.CartToJnt(q, dq, ddq, wrenches, torque) == KDL::SolverI::E_NOERROR;
  }

  /// Says which of the given values brought no result.
  [[noreturn]] void refuse(std::initializer_list<Given> all, const TipWrench& wrench = {}) const {
    std::ostringstream sentence;
    sentence << "robot '" << description.name << "': ";
    double largest = 0.0;
    for (const Given& given : all) {
      for (Eigen::Index i = 0; i < given.values.size(); ++i) {
        const ArmJoint& joint = description.joints[static_cast<std::size_t>(i)];
        largest = std::max(largest, std::abs(given.values[i]));
        if (std::isfinite(given.values[i])) continue;
        sentence << given.symbol << " of joint '" << joint.name << "' is " << given.values[i] << ", expected a finite "
                 << given.quantity << " in " << (joint.type == JointType::prismatic ? "m" : "rad") << given.per;
        throw ModelError(sentence.str());
      }
    }
    if (!wrench.force.allFinite() || !wrench.torque.allFinite()) {
      sentence << "the wrench at tip '" << description.tip << "' is not finite, expected N and N m";
    } else {
      sentence << "the result overflows; the largest value given is " << largest;
    }
    throw ModelError(sentence.str());
  }

  RobotDescription description;
  KDL::Chain chain;
  KDL::ChainFkSolverPos_recursive kinematics;
  KDL::ChainJntToJacSolver jacobian;
  KDL::ChainDynParam dynamics;
  KDL::ChainIdSolver_RNE inverse_dynamics;
  KDL::JntArray q, dq, ddq, torque;
  KDL::Jacobian twists;
  KDL::JntSpaceInertiaMatrix mass;
  KDL::Wrenches wrenches;
  std::mutex turn;  // of the threads that share this work space
};

RobotModel::RobotModel(RobotDescription description)
    : implementation_(std::make_unique<Implementation>(std::move(description))) {}
RobotModel::~RobotModel() = default;
RobotModel::RobotModel(RobotModel&&) noexcept = default;
RobotModel& RobotModel::operator=(RobotModel&&) noexcept = default;

const RobotDescription& RobotModel::description() const { return implementation_->description; }
int RobotModel::size() const { return implementation_->size(); }

bool RobotModel::forwardKinematics(const Eigen::VectorXd& q, Eigen::Isometry3d& result) const {
  Implementation& own = *implementation_;
  own.requireSize("q", q);
  const std::lock_guard<std::mutex> turn(own.turn);
  KDL::Frame frame;
  const bool found = own.take(q, own.q) && own.kinematics.JntToCart(own.q, frame) == KDL::SolverI::E_NOERROR;
  Eigen::Matrix<double, 3, 4> affine;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) affine(row, column) = frame.M(row, column);
    affine(row, 3) = frame.p(row);
  }
  result.setIdentity();
  return own.give(found, affine, result.affine());
}

bool RobotModel::jacobian(const Eigen::VectorXd& q, Eigen::MatrixXd& result) const {
  Implementation& own = *implementation_;
  own.requireSize("q", q);
  const std::lock_guard<std::mutex> turn(own.turn);
  const bool found = own.take(q, own.q) && own.jacobian.JntToJac(own.q, own.twists) == KDL::SolverI::E_NOERROR;
  return own.give(found, own.twists.data, result);
}

bool RobotModel::gravity(const Eigen::VectorXd& q, Eigen::VectorXd& result) const {
  Implementation& own = *implementation_;
  own.requireInertia();
  own.requireSize("q", q);
  const std::lock_guard<std::mutex> turn(own.turn);
  const bool found = own.take(q, own.q) && own.dynamics.JntToGravity(own.q, own.torque) == KDL::SolverI::E_NOERROR;
  return own.give(found, own.torque.data, result);
}

bool RobotModel::massMatrix(const Eigen::VectorXd& q, Eigen::MatrixXd& result) const {
  Implementation& own = *implementation_;
  own.requireInertia();
  own.requireSize("q", q);
  const std::lock_guard<std::mutex> turn(own.turn);
  const bool found = own.take(q, own.q) && own.dynamics.JntToMass(own.q, own.mass) == KDL::SolverI::E_NOERROR;
  return own.give(found, own.mass.data, result);
}

bool RobotModel::coriolis(const Eigen::VectorXd& q, const Eigen::VectorXd& dq, Eigen::VectorXd& result) const {
  Implementation& own = *implementation_;
  own.requireInertia();
  own.requireSize("q", q);
  own.requireSize("dq", dq);
  const std::lock_guard<std::mutex> turn(own.turn);
  const bool found = own.take(q, own.q) && own.take(dq, own.dq) &&
                     own.dynamics.JntToCoriolis(own.q, own.dq, own.torque) == KDL::SolverI::E_NOERROR;
  return own.give(found, own.torque.data, result);
}

bool RobotModel::inverseDynamics(const Eigen::VectorXd& q, const Eigen::VectorXd& dq, const Eigen::VectorXd& ddq,
                                 const TipWrench& wrench, Eigen::VectorXd& result) const {
  Implementation& own = *implementation_;
  const std::lock_guard<std::mutex> turn(own.turn);
  const bool found = own.solveInverseDynamics(q, dq, ddq, wrench);
  return own.give(found, own.torque.data, result);
}

bool RobotModel::friction(const Eigen::VectorXd& dq, Eigen::VectorXd& result) const {
  const Implementation& own = *implementation_;
  own.requireSize("dq", dq);
  result.resize(own.size());
  bool finite = dq.allFinite();
  for (Eigen::Index i = 0; i < dq.size(); ++i) {
    result[i] = own.frictionOf(i, dq[i]);
    finite = finite && std::isfinite(result[i]);
  }
  if (!finite) result.setConstant(kNaN);
  return finite;
}

bool RobotModel::motorTorque(const Eigen::VectorXd& q, const Eigen::VectorXd& dq, const Eigen::VectorXd& ddq,
                             const TipWrench& wrench, Eigen::VectorXd& result) const {
  Implementation& own = *implementation_;
  const std::lock_guard<std::mutex> turn(own.turn);
  const bool found = own.solveInverseDynamics(q, dq, ddq, wrench);
  for (Eigen::Index i = 0; found && i < own.size(); ++i) {
    own.torque(static_cast<unsigned>(i)) +=
        own.description.joints[static_cast<std::size_t>(i)].motor_inertia * ddq[i] + own.frictionOf(i, dq[i]);
  }
  return own.give(found, own.torque.data, result);
}

bool RobotModel::inverseDynamics(const Eigen::VectorXd& q, const Eigen::VectorXd& dq, const Eigen::VectorXd& ddq,
                                 Eigen::VectorXd& result) const {
  return inverseDynamics(q, dq, ddq, TipWrench(), result);
}

bool RobotModel::motorTorque(const Eigen::VectorXd& q, const Eigen::VectorXd& dq, const Eigen::VectorXd& ddq,
                             Eigen::VectorXd& result) const {
  return motorTorque(q, dq, ddq, TipWrench(), result);
}

Eigen::Isometry3d RobotModel::forwardKinematics(const Eigen::VectorXd& q) const {
  Eigen::Isometry3d result;
  if (!forwardKinematics(q, result)) implementation_->refuse({position(q)});
  return result;
}

Eigen::MatrixXd RobotModel::jacobian(const Eigen::VectorXd& q) const {
  Eigen::MatrixXd result;
  if (!jacobian(q, result)) implementation_->refuse({position(q)});
  return result;
}

Eigen::VectorXd RobotModel::gravity(const Eigen::VectorXd& q) const {
  Eigen::VectorXd result;
  if (!gravity(q, result)) implementation_->refuse({position(q)});
  return result;
}

Eigen::MatrixXd RobotModel::massMatrix(const Eigen::VectorXd& q) const {
  Eigen::MatrixXd result;
  if (!massMatrix(q, result)) implementation_->refuse({position(q)});
  return result;
}

Eigen::VectorXd RobotModel::coriolis(const Eigen::VectorXd& q, const Eigen::VectorXd& dq) const {
  Eigen::VectorXd result;
  if (!coriolis(q, dq, result)) implementation_->refuse({position(q), velocity(dq)});
  return result;
}

Eigen::VectorXd RobotModel::inverseDynamics(const Eigen::VectorXd& q, const Eigen::VectorXd& dq,
                                            const Eigen::VectorXd& ddq, const TipWrench& wrench) const {
  Eigen::VectorXd result;
  if (!inverseDynamics(q, dq, ddq, wrench, result)) {
    implementation_->refuse({position(q), velocity(dq), acceleration(ddq)}, wrench);
  }
  return result;
}

Eigen::VectorXd RobotModel::friction(const Eigen::VectorXd& dq) const {
  Eigen::VectorXd result;
  if (!friction(dq, result)) implementation_->refuse({velocity(dq)});
  return result;
}

Eigen::VectorXd RobotModel::motorTorque(const Eigen::VectorXd& q, const Eigen::VectorXd& dq, const Eigen::VectorXd& ddq,
                                        const TipWrench& wrench) const {
  Eigen::VectorXd result;
  if (!motorTorque(q, dq, ddq, wrench, result)) {
    implementation_->refuse({position(q), velocity(dq), acceleration(ddq)}, wrench);
  }
  return result;
}

}  // namespace demo_logger
