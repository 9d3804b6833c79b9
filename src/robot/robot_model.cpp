#include "demo_logger/robot/robot_model.h"

#include <Eigen/Core>
#include <kdl/chain.hpp>
#include <kdl/chaindynparam.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainidsolver_recursive_newton_euler.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <limits>
#include <string>
#include <utility>

#include "demo_logger/trajectory/error.h"

namespace demo_logger {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

KDL::Vector toKdl(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

KDL::Frame toKdl(const Eigen::Isometry3d& X) {
  const Eigen::Matrix3d R = X.linear();
  return {KDL::Rotation(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)),
          toKdl(X.translation())};
}

KDL::RigidBodyInertia toKdl(const BodyInertia& body) {
  const Eigen::Matrix3d& I = body.inertia;
  return KDL::RigidBodyInertia(body.mass, toKdl(body.center),
                               KDL::RotationalInertia(I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2)));
}

KDL::Chain makeChain(const RobotDescription& description) {
  KDL::Chain chain;
  for (const ArmJoint& joint : description.joints) {
    const KDL::Frame X_parent_joint = toKdl(joint.X_parent_joint);
    const auto type = joint.type == JointType::prismatic ? KDL::Joint::TransAxis : KDL::Joint::RotAxis;
    chain.addSegment(KDL::Segment(joint.link,
                                  KDL::Joint(joint.name, X_parent_joint.p, X_parent_joint.M * toKdl(joint.axis), type),
                                  X_parent_joint, toKdl(joint.body)));
  }
  chain.addSegment(KDL::Segment("tip", KDL::Joint("tip", KDL::Joint::Fixed), toKdl(description.X_lastlink_tip)));
  return chain;
}

}  // namespace

/// KDL's solvers keep a reference to the chain, and its joints remember their last pose: chain, solvers and work space
/// stay together here, and never move.
class RobotModel::Implementation {
 public:
  explicit Implementation(RobotDescription given)
      : description(std::move(given)),
        chain(makeChain(description)),
        kinematics(chain),
        jacobian(chain),
        dynamics(chain, toKdl(description.gravity)),
        inverse_dynamics(chain, toKdl(description.gravity)),
        q(chain.getNrOfJoints()),
        dq(q),
        ddq(q),
        torque(q),
        twists(chain.getNrOfJoints()),
        mass(chain.getNrOfJoints()),
        no_wrenches(chain.getNrOfSegments(), KDL::Wrench::Zero()) {}

  int size() const { return static_cast<int>(description.joints.size()); }

  /// Copies into KDL's vector; false if a value is not finite, which KDL would not report.
  bool take(const char* what, const Eigen::VectorXd& values, KDL::JntArray& target) const {
    if (values.size() != size()) {
      throw ModelError("robot '" + description.name + "': " + what + " has " + std::to_string(values.size()) +
                       " values, expected one for each of its " + std::to_string(size()) + " joints");
    }
    target.data = values;
    return values.allFinite();
  }

  void requireInertia() const {
    if (!description.has_inertia) {
      throw ModelError("no dynamics for robot '" + description.name + "': " + description.inertia_fault);
    }
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
  KDL::Wrenches no_wrenches;
};

RobotModel::RobotModel(RobotDescription description)
    : implementation_(std::make_unique<Implementation>(std::move(description))) {}
RobotModel::~RobotModel() = default;
RobotModel::RobotModel(RobotModel&&) noexcept = default;
RobotModel& RobotModel::operator=(RobotModel&&) noexcept = default;

const RobotDescription& RobotModel::description() const { return implementation_->description; }
int RobotModel::size() const { return implementation_->size(); }

Eigen::Isometry3d RobotModel::forwardKinematics(const Eigen::VectorXd& q) const {
  Implementation& own = *implementation_;
  Eigen::Isometry3d X_base_tip = Eigen::Isometry3d::Identity();
  if (!own.take("q", q, own.q)) {
    X_base_tip.affine().setConstant(kNan);
    return X_base_tip;
  }
  KDL::Frame frame;
  own.kinematics.JntToCart(own.q, frame);
  for (int row = 0; row < 3; ++row) {
    X_base_tip.translation()[row] = frame.p(row);
    for (int column = 0; column < 3; ++column) X_base_tip.linear()(row, column) = frame.M(row, column);
  }
  return X_base_tip;
}

void RobotModel::jacobian(const Eigen::VectorXd& q, Eigen::MatrixXd& result) const {
  Implementation& own = *implementation_;
  result.resize(6, own.size());
  if (!own.take("q", q, own.q)) {
    result.setConstant(kNan);
    return;
  }
  own.jacobian.JntToJac(own.q, own.twists);
  result = own.twists.data;
}

void RobotModel::gravity(const Eigen::VectorXd& q, Eigen::VectorXd& result) const {
  Implementation& own = *implementation_;
  own.requireInertia();
  result.resize(own.size());
  if (!own.take("q", q, own.q)) {
    result.setConstant(kNan);
    return;
  }
  own.dynamics.JntToGravity(own.q, own.torque);
  result = own.torque.data;
}

void RobotModel::massMatrix(const Eigen::VectorXd& q, Eigen::MatrixXd& result) const {
  Implementation& own = *implementation_;
  own.requireInertia();
  result.resize(own.size(), own.size());
  if (!own.take("q", q, own.q)) {
    result.setConstant(kNan);
    return;
  }
  own.dynamics.JntToMass(own.q, own.mass);
  result = own.mass.data;
}

void RobotModel::coriolis(const Eigen::VectorXd& q, const Eigen::VectorXd& dq, Eigen::VectorXd& result) const {
  Implementation& own = *implementation_;
  own.requireInertia();
  result.resize(own.size());
  const bool finite_q = own.take("q", q, own.q);
  const bool finite_dq = own.take("dq", dq, own.dq);
  if (!finite_q || !finite_dq) {
    result.setConstant(kNan);
    return;
  }
  own.dynamics.JntToCoriolis(own.q, own.dq, own.torque);
  result = own.torque.data;
}

void RobotModel::inverseDynamics(const Eigen::VectorXd& q, const Eigen::VectorXd& dq, const Eigen::VectorXd& ddq,
                                 Eigen::VectorXd& result) const {
  Implementation& own = *implementation_;
  own.requireInertia();
  result.resize(own.size());
  const bool finite_q = own.take("q", q, own.q);
  const bool finite_dq = own.take("dq", dq, own.dq);
  const bool finite_ddq = own.take("ddq", ddq, own.ddq);
  if (!finite_q || !finite_dq || !finite_ddq) {
    result.setConstant(kNan);
    return;
  }
  own.inverse_dynamics.CartToJnt(own.q, own.dq, own.ddq, own.no_wrenches, own.torque);
  result = own.torque.data;
}

Eigen::MatrixXd RobotModel::jacobian(const Eigen::VectorXd& q) const {
  Eigen::MatrixXd result;
  jacobian(q, result);
  return result;
}

Eigen::VectorXd RobotModel::gravity(const Eigen::VectorXd& q) const {
  Eigen::VectorXd result;
  gravity(q, result);
  return result;
}

Eigen::MatrixXd RobotModel::massMatrix(const Eigen::VectorXd& q) const {
  Eigen::MatrixXd result;
  massMatrix(q, result);
  return result;
}

Eigen::VectorXd RobotModel::coriolis(const Eigen::VectorXd& q, const Eigen::VectorXd& dq) const {
  Eigen::VectorXd result;
  coriolis(q, dq, result);
  return result;
}

Eigen::VectorXd RobotModel::inverseDynamics(const Eigen::VectorXd& q, const Eigen::VectorXd& dq,
                                            const Eigen::VectorXd& ddq) const {
  Eigen::VectorXd result;
  inverseDynamics(q, dq, ddq, result);
  return result;
}

}  // namespace demo_logger
