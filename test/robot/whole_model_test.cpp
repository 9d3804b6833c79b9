// Dynamics of arms at random against d'Alembert's principle, body by body: a body of mass m whose centre moves by J_v,
// and which turns by J_ω, needs the joint torques J_vᵀ m (a − g) + J_ωᵀ I α.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/trajectory/error.h"
#include "test/robot/own_arms.h"
#include "test/robot/random_arm.h"

namespace demo_logger {
namespace {

constexpr double kRelative = 1e-12;  // of the largest number met: a few hundred roundings

struct State {
  Eigen::VectorXd q, dq, ddq;
};

State randomState(int size, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> value(-3.0, 3.0);
  const auto vector = [&] { return Eigen::VectorXd::NullaryExpr(size, [&] { return value(generator); }).eval(); };
  State state;
  state.q = vector();
  state.dq = vector();
  state.ddq = vector();
  return state;
}

struct Case {
  RobotDescription arm;
  State state;
};

Case randomCase() {
  const auto seed = *rc::gen::arbitrary<unsigned>();
  Case made{makeRandomArm(seed), {}};
  made.state = randomState(static_cast<int>(made.arm.joints.size()), seed + 1);
  return made;
}

void checkNear(const Eigen::MatrixXd& ours, const Eigen::MatrixXd& theirs) {
  const double scale = std::max(1.0, theirs.cwiseAbs().maxCoeff());
  RC_ASSERT((ours - theirs).cwiseAbs().maxCoeff() < kRelative * scale);
}

/// The chain up to a body, with its tip in the body's centre of mass: the Jacobian of that centre, for all n joints.
struct BodyMotion {
  Eigen::MatrixXd J_v, J_omega;  // 3 x n, base axes
  Eigen::Matrix3d R_base_body;
};

BodyMotion motionOf(const RobotDescription& arm, std::size_t body, const Eigen::VectorXd& q) {
  const auto count = static_cast<Eigen::Index>(body + 1);
  RobotDescription shortened = arm;
  shortened.joints.resize(body + 1);
  shortened.X_lastlink_tip = Eigen::Translation3d(arm.joints[body].body.center);
  const RobotModel model(shortened);
  const Eigen::MatrixXd J = model.jacobian(q.head(count));
  BodyMotion motion{Eigen::MatrixXd::Zero(3, q.size()), Eigen::MatrixXd::Zero(3, q.size()),
                    model.forwardKinematics(q.head(count)).linear()};
  motion.J_v.leftCols(count) = J.topRows(3);
  motion.J_omega.leftCols(count) = J.bottomRows(3);
  return motion;
}

RC_GTEST_PROP(WholeModelTest, MassMatrixAndGravityAreSumsOverTheBodies, ()) {
  const auto [arm, state] = randomCase();
  const auto n = static_cast<Eigen::Index>(arm.joints.size());
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd gravity = Eigen::VectorXd::Zero(n);
  for (std::size_t i = 0; i < arm.joints.size(); ++i) {
    const BodyInertia& body = arm.joints[i].body;
    const BodyMotion motion = motionOf(arm, i, state.q);
    const Eigen::Matrix3d inertia = motion.R_base_body * body.inertia * motion.R_base_body.transpose();
    mass += body.mass * motion.J_v.transpose() * motion.J_v + motion.J_omega.transpose() * inertia * motion.J_omega;
    gravity -= body.mass * motion.J_v.transpose() * arm.gravity;
  }
  const RobotModel model(arm);
  checkNear(model.massMatrix(state.q), mass);
  checkNear(model.gravity(state.q), gravity);
}

RC_GTEST_PROP(WholeModelTest, InverseDynamicsIsTheSumOfItsTerms, ()) {
  const auto [arm, state] = randomCase();
  const RobotModel model(arm);
  checkNear(model.inverseDynamics(state.q, state.dq, state.ddq),
            model.massMatrix(state.q) * state.ddq + model.coriolis(state.q, state.dq) + model.gravity(state.q));
}

RC_GTEST_PROP(WholeModelTest, AWrenchAtTheTipTakesItsShareByTheJacobian, ()) {
  const auto [arm, state] = randomCase();
  const RobotModel model(arm);
  const State six = randomState(6, *rc::gen::arbitrary<unsigned>());
  const TipWrench wrench{10.0 * six.q.head<3>(), six.q.tail<3>()};
  Eigen::VectorXd stacked(6);
  stacked << wrench.force, wrench.torque;
  const Eigen::VectorXd share = model.jacobian(state.q).transpose() * stacked;
  checkNear(model.inverseDynamics(state.q, state.dq, state.ddq, wrench),
            model.inverseDynamics(state.q, state.dq, state.ddq) - share);
  checkNear(model.motorTorque(state.q, state.dq, state.ddq, wrench),
            model.motorTorque(state.q, state.dq, state.ddq) - share);
  const State alone = randomState(model.size(), 1);
  RC_ASSERT(model.motorTorque(alone.q, alone.dq, alone.ddq) ==
            RobotModel(arm).motorTorque(alone.q, alone.dq, alone.ddq));
}

RC_GTEST_PROP(WholeModelTest, ALoadIsAnotherBodyAtTheTip, ()) {
  const auto [arm, state] = randomCase();
  const RobotDescription donor = makeRandomArm(*rc::gen::arbitrary<unsigned>());
  const BodyInertia load = donor.joints.front().body;
  RobotDescription held_there = arm;
  held_there.X_lastlink_tip = arm.X_lastlink_tip * Eigen::Translation3d(load.center);
  const RobotModel at_load(held_there);
  const Eigen::MatrixXd J = at_load.jacobian(state.q);
  const Eigen::Matrix3d R = at_load.forwardKinematics(state.q).linear();

  const RobotModel empty(arm), loaded(withLoad(arm, load));
  const Eigen::VectorXd acceleration = J.topRows(3) * state.ddq - arm.gravity;
  const Eigen::VectorXd share = J.topRows(3).transpose() * load.mass * acceleration + J.bottomRows(3).transpose() * R *
                                                                                          load.inertia * R.transpose() *
                                                                                          J.bottomRows(3) * state.ddq;
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(state.q.size());
  checkNear(loaded.inverseDynamics(state.q, rest, state.ddq), empty.inverseDynamics(state.q, rest, state.ddq) + share);
}

TEST(WholeModelTest, MotorsAlsoTurnThemselvesAndOvercomeFriction) {
  RobotDescription arm = describeOwnArm("two_link");
  arm = withDrives(arm, {{arm.joints[0].name, {0.3, 0.5, 2.0, 0.1}}, {arm.joints[1].name, {0.0, 0.7, 3.0, 0.0}}});
  const RobotModel model(arm);
  const Eigen::Vector2d q(0.3, -0.8), dq(0.05, -0.4), ddq(2.0, 1.0);
  const Eigen::Vector2d friction(0.5 * 0.05 + 2.0 * std::tanh(0.5), 0.7 * -0.4 - 3.0);
  EXPECT_TRUE(model.friction(dq).isApprox(friction, 1e-15));
  const Eigen::Vector2d expected = model.inverseDynamics(q, dq, ddq) + Eigen::Vector2d(0.3 * 2.0, 0.0) + friction;
  EXPECT_TRUE(model.motorTorque(q, dq, ddq).isApprox(expected, 1e-15));
  EXPECT_TRUE(model.friction(Eigen::Vector2d::Zero()).isZero(0.0)) << "at rest it takes what comes, here nothing";
}

TEST(WholeModelTest, DrivesThatCannotBeAreRefused) {
  const RobotDescription arm = describeOwnArm("two_link");
  const auto errorOf = [&arm](const std::string& joint, const JointDrive& drive) -> std::string {
    try {
      withDrives(arm, {{joint, drive}});
    } catch (const ModelError& error) {
      return error.what();
    }
    return "no error";
  };
  const std::string first = arm.joints[0].name;
  EXPECT_EQ(errorOf(first, {-0.1, {}, {}, {}}),
            "joint '" + first + "' cannot have the motor inertia -0.1, expected 0 or more");
  EXPECT_EQ(errorOf(first, {{}, {}, std::nan(""), {}}),
            "joint '" + first + "' cannot have the friction nan, expected 0 or more");
  EXPECT_EQ(errorOf("joint_2b", {}),
            "no joint 'joint_2b' to drive in the arm of robot 'two_link'; the nearest names are '" +
                arm.joints[1].name + "', '" + first + "'");
  EXPECT_EQ(errorOf(first, {0.1, {}, {}, {}}), "no error");
}

}  // namespace
}  // namespace demo_logger
