#include "demo_logger/robot/robot_model.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <functional>
#include <limits>
#include <random>
#include <string>

#include "demo_logger/trajectory/error.h"
#include "test/robot/own_arms.h"
#include "test/robot/two_link_by_hand.h"

namespace demo_logger {
namespace {

constexpr double kClosedForm = 1e-12;  // [m, kg m², N m]: a few hundred roundings of numbers of order 10
constexpr int kStates = 200;

class RandomVectors {
 public:
  explicit RandomVectors(unsigned seed) : generator_(seed) {}
  Eigen::VectorXd operator()(int size, double bound) {
    std::uniform_real_distribution<double> value(-bound, bound);
    Eigen::VectorXd vector(size);
    for (int i = 0; i < size; ++i) vector[i] = value(generator_);
    return vector;
  }

 private:
  std::mt19937 generator_;
};

std::string errorOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const ModelError& error) {
    return error.what();
  }
  return "no error";
}

TEST(RobotModelTest, TheTwoLinkArmFollowsItsClosedForm) {
  const RobotModel model(describeOwnArm("two_link"));
  RandomVectors random(1);
  for (int state = 0; state < kStates; ++state) {
    const Eigen::VectorXd q = random(2, 3.0), dq = random(2, 2.0), ddq = random(2, 10.0);
    const Eigen::Isometry3d X_base_tip = model.forwardKinematics(q);
    EXPECT_LT((X_base_tip.translation() - TwoLinkByHand::tip(q)).norm(), kClosedForm);
    EXPECT_LT((X_base_tip.linear() - Eigen::AngleAxisd(q.sum(), Eigen::Vector3d::UnitY()).matrix()).norm(),
              kClosedForm);
    EXPECT_LT((model.massMatrix(q) - TwoLinkByHand::mass(q)).norm(), kClosedForm);
    EXPECT_LT((model.coriolis(q, dq) - TwoLinkByHand::coriolis(q, dq)).norm(), kClosedForm);
    EXPECT_LT((model.gravity(q) - TwoLinkByHand::gravity(q)).norm(), kClosedForm);
    const Eigen::Vector2d torque =
        TwoLinkByHand::mass(q) * ddq + TwoLinkByHand::coriolis(q, dq) + TwoLinkByHand::gravity(q);
    EXPECT_LT((model.inverseDynamics(q, dq, ddq) - torque).norm(), kClosedForm);
  }
}

/// Central differences of step h err by h²/6 times the third derivative (here below 2) and by rounding 1e-16/h.
TEST(RobotModelTest, TheJacobianIsTheDerivativeOfForwardKinematics) {
  constexpr double h = 1e-5;
  constexpr double kTolerance = 1e-9;
  for (const std::string name : {"demo_arm", "two_link"}) {
    const RobotModel model(describeOwnArm(name));
    RandomVectors random(2);
    for (int state = 0; state < kStates; ++state) {
      const Eigen::VectorXd q = random(model.size(), 2.5);
      const Eigen::MatrixXd J = model.jacobian(q);
      ASSERT_EQ(J.rows(), 6);
      ASSERT_EQ(J.cols(), model.size());
      for (int i = 0; i < model.size(); ++i) {
        Eigen::VectorXd before = q, after = q;
        before[i] -= h;
        after[i] += h;
        const Eigen::Isometry3d X_before = model.forwardKinematics(before);
        const Eigen::Isometry3d X_after = model.forwardKinematics(after);
        const Eigen::Vector3d v = (X_after.translation() - X_before.translation()) / (2.0 * h);
        const Eigen::AngleAxisd turn(X_after.linear() * X_before.linear().transpose());
        const Eigen::Vector3d omega = turn.angle() * turn.axis() / (2.0 * h);
        EXPECT_LT((J.col(i).head(3) - v).norm(), kTolerance) << name << " joint " << i + 1;
        EXPECT_LT((J.col(i).tail(3) - omega).norm(), kTolerance) << name << " joint " << i + 1;
      }
    }
  }
}

/// d/dt of the kinetic energy ½ q̇ᵀ M q̇ is q̇ᵀ (M q̈ + C q̇): true for every C, so Ṁ comes from differences here.
TEST(RobotModelTest, MassMatrixAndCoriolisTorqueKeepTheEnergy) {
  constexpr double h = 1e-5;
  const RobotModel model(describeOwnArm("demo_arm"));
  RandomVectors random(3);
  for (int state = 0; state < kStates; ++state) {
    const Eigen::VectorXd q = random(7, 2.5), dq = random(7, 2.0);
    const Eigen::MatrixXd rate = (model.massMatrix(q + h * dq) - model.massMatrix(q - h * dq)) / (2.0 * h);
    EXPECT_NEAR(dq.dot(model.coriolis(q, dq)), 0.5 * dq.dot(rate * dq), 1e-7);
    const Eigen::MatrixXd M = model.massMatrix(q);
    EXPECT_TRUE(M.isApprox(M.transpose(), 1e-13));
    EXPECT_GT(M.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0.0);
  }
}

TEST(RobotModelTest, InverseDynamicsIsTheSumOfItsTerms) {
  const RobotModel model(describeOwnArm("demo_arm"));
  RandomVectors random(4);
  for (int state = 0; state < kStates; ++state) {
    const Eigen::VectorXd q = random(7, 2.5), dq = random(7, 2.0), ddq = random(7, 10.0);
    const Eigen::VectorXd sum = model.massMatrix(q) * ddq + model.coriolis(q, dq) + model.gravity(q);
    EXPECT_LT((model.inverseDynamics(q, dq, ddq) - sum).norm(), kClosedForm);
  }
}

TEST(RobotModelTest, ValuesThatAreNotFiniteAreRefusedByName) {
  const RobotModel model(describeOwnArm("demo_arm"));
  const Eigen::VectorXd fine = Eigen::VectorXd::Constant(7, 0.4);
  Eigen::VectorXd nan = fine, infinite = fine;
  nan[6] = std::numeric_limits<double>::quiet_NaN();
  infinite[1] = -std::numeric_limits<double>::infinity();
  const std::string position = "robot 'demo_arm': q of joint 'joint_7' is nan, expected a finite position in rad";
  EXPECT_EQ(errorOf([&] { model.forwardKinematics(nan); }), position);
  EXPECT_EQ(errorOf([&] { model.jacobian(nan); }), position);
  EXPECT_EQ(errorOf([&] { model.gravity(nan); }), position);
  EXPECT_EQ(errorOf([&] { model.massMatrix(nan); }), position);
  EXPECT_EQ(errorOf([&] { model.coriolis(nan, fine); }), position);
  EXPECT_EQ(errorOf([&] { model.inverseDynamics(nan, fine, fine); }), position);
  EXPECT_EQ(errorOf([&] { model.motorTorque(nan, fine, fine); }), position);
  const std::string velocity = "robot 'demo_arm': dq of joint 'joint_2' is -inf, expected a finite velocity in rad/s";
  EXPECT_EQ(errorOf([&] { model.coriolis(fine, infinite); }), velocity);
  EXPECT_EQ(errorOf([&] { model.inverseDynamics(fine, infinite, fine); }), velocity);
  EXPECT_EQ(errorOf([&] { model.motorTorque(fine, infinite, fine); }), velocity);
  EXPECT_EQ(errorOf([&] { model.friction(infinite); }), velocity);
  EXPECT_EQ(errorOf([&] { model.inverseDynamics(fine, fine, infinite); }),
            "robot 'demo_arm': ddq of joint 'joint_2' is -inf, expected a finite acceleration in rad/s²");
  TipWrench wrench;
  wrench.torque.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(errorOf([&] { model.inverseDynamics(fine, fine, fine, wrench); }),
            "robot 'demo_arm': the wrench at tip 'tool_tip' is not finite, expected N and N m");
  EXPECT_EQ(errorOf([&] { model.inverseDynamics(fine, 1e200 * fine, fine); }),
            "robot 'demo_arm': the result overflows; the largest value given is 4e+199");
  EXPECT_TRUE(model.gravity(fine).allFinite()) << "a bad value leaves nothing behind";
}

TEST(RobotModelTest, AControlLoopIsToldWithoutAnException) {
  const RobotModel model(describeOwnArm("demo_arm"));
  const Eigen::VectorXd fine = Eigen::VectorXd::Constant(7, 0.4);
  Eigen::Isometry3d pose;
  Eigen::MatrixXd matrix;
  Eigen::VectorXd torque;
  for (const double poison : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Eigen::VectorXd bad = fine;
    bad[6] = poison;
    EXPECT_FALSE(model.forwardKinematics(bad, pose));
    EXPECT_TRUE(pose.affine().array().isNaN().all());
    EXPECT_FALSE(model.jacobian(bad, matrix));
    EXPECT_TRUE(matrix.array().isNaN().all());
    EXPECT_FALSE(model.massMatrix(bad, matrix));
    EXPECT_TRUE(matrix.array().isNaN().all());
    const auto expectNone = [&torque](bool found) {
      EXPECT_FALSE(found);
      ASSERT_EQ(torque.size(), 7);
      EXPECT_TRUE(torque.array().isNaN().all());
      torque.setZero();
    };
    expectNone(model.gravity(bad, torque));
    expectNone(model.coriolis(fine, bad, torque));
    expectNone(model.inverseDynamics(bad, fine, fine, torque));
    expectNone(model.inverseDynamics(fine, bad, fine, torque));
    expectNone(model.inverseDynamics(fine, fine, bad, torque));
    expectNone(model.inverseDynamics(fine, fine, fine, {{poison, 0.0, 0.0}, {}}, torque));
    expectNone(model.motorTorque(fine, fine, bad, torque));
    expectNone(model.friction(bad, torque));
  }
  EXPECT_FALSE(model.inverseDynamics(fine, 1e200 * fine, fine, torque)) << "finite in, overflow inside";
  EXPECT_TRUE(torque.array().isNaN().all());
  EXPECT_TRUE(model.gravity(fine, torque)) << "a bad value leaves nothing behind";
  EXPECT_EQ(torque, model.gravity(fine));
}

TEST(RobotModelTest, AWrongSizeIsNamed) {
  const RobotModel model(describeOwnArm("demo_arm"));
  const Eigen::VectorXd six = Eigen::VectorXd::Zero(6), seven = Eigen::VectorXd::Zero(7);
  const auto sentence = [](const std::string& what) {
    return "robot 'demo_arm': " + what + " has 6 values, expected one for each of its 7 joints";
  };
  EXPECT_EQ(errorOf([&] { model.forwardKinematics(six); }), sentence("q"));
  EXPECT_EQ(errorOf([&] { model.jacobian(six); }), sentence("q"));
  EXPECT_EQ(errorOf([&] { model.coriolis(seven, six); }), sentence("dq"));
  EXPECT_EQ(errorOf([&] { model.inverseDynamics(seven, seven, six); }), sentence("ddq"));
}

TEST(RobotModelTest, ResultsGoIntoTheCallersMemory) {
  const RobotModel model(describeOwnArm("demo_arm"));
  const Eigen::VectorXd q = Eigen::VectorXd::Constant(7, 0.4);
  Eigen::VectorXd torque(7);
  const double* memory = torque.data();
  model.inverseDynamics(q, q, q, torque);
  EXPECT_EQ(torque.data(), memory);
  EXPECT_EQ(torque, model.inverseDynamics(q, q, q));
}

TEST(RobotModelTest, AnArmNeedsAJoint) {
  RobotDescription nothing;
  nothing.name = "post";
  EXPECT_EQ(errorOf([&] { RobotModel{nothing}; }), "robot 'post' has no joint to move");
}

TEST(RobotModelTest, CanBeMovedIntoItsPlace) {
  RobotModel model(describeOwnArm("two_link"));
  const Eigen::VectorXd q = Eigen::VectorXd::Constant(2, 0.4);
  const Eigen::VectorXd torque = model.gravity(q);
  const RobotModel moved = std::move(model);
  EXPECT_EQ(moved.gravity(q), torque);
  EXPECT_EQ(moved.description().name, "two_link");
}

}  // namespace
}  // namespace demo_logger
