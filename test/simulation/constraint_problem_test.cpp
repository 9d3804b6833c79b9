#include "src/simulation/constraint_problem.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <random>

namespace demo_logger {
namespace {

constexpr double kExact = 1e-9;  // the softness of rows is 1e-12

Eigen::MatrixXd randomInverseMass(int joints, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Eigen::MatrixXd root(joints, joints);
  for (double& value : root.reshaped()) value = normal(random);
  return root * root.transpose() + 0.1 * Eigen::MatrixXd::Identity(joints, joints);
}

TEST(ConstraintProblemTest, WithoutRowsNothingChanges) {
  ConstraintProblem problem;
  problem.clear();
  Eigen::VectorXd velocity = Eigen::Vector2d(1.0, -2.0);
  problem.solve(Eigen::Matrix2d::Identity(), velocity);
  EXPECT_EQ(velocity, Eigen::Vector2d(1.0, -2.0));
}

TEST(ConstraintProblemTest, AJointIsStoppedWithinTheBoundsOfTheImpulse) {
  ConstraintProblem problem;
  problem.clear();
  problem.addJoint(0, 0.0, -0.5, 0.5);
  problem.addJoint(1, 0.0, -0.5, 0.5);
  Eigen::VectorXd velocity = Eigen::Vector2d(0.3, -2.0);  // masses of 1 kg: 0.3 N s stop one, the other needs 2 N s
  problem.solve(Eigen::Matrix2d::Identity(), velocity);
  EXPECT_NEAR(velocity[0], 0.0, kExact);
  EXPECT_NEAR(problem.impulse(0), -0.3, kExact);
  EXPECT_NEAR(velocity[1], -1.5, kExact);
  EXPECT_NEAR(problem.impulse(1), 0.5, kExact);
}

/// The conditions of a box-constrained problem are necessary and sufficient, so they judge any solver.
TEST(ConstraintProblemTest, EveryRowMeetsItsTargetOrIsAtTheBoundThatPushesTowardsIt) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  int at_bound = 0;
  int free = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const int joints = 7;
    const Eigen::MatrixXd W = randomInverseMass(joints, random);
    ConstraintProblem problem;
    problem.clear();
    Eigen::VectorXd velocity(joints);
    Eigen::VectorXd targets(joints);
    const double bound = 0.2;
    for (int i = 0; i < joints; ++i) {
      velocity[i] = number(random);
      targets[i] = 0.3 * number(random);
      problem.addJoint(i, targets[i], -bound, bound);
    }
    problem.solve(W, velocity);
    for (int i = 0; i < joints; ++i) {
      const double impulse = problem.impulse(i);
      ASSERT_LE(std::abs(impulse), bound * (1.0 + 1e-12));
      if (impulse > bound * (1.0 - 1e-12)) {
        EXPECT_LE(velocity[i], targets[i] + kExact);
        ++at_bound;
      } else if (impulse < -bound * (1.0 - 1e-12)) {
        EXPECT_GE(velocity[i], targets[i] - kExact);
        ++at_bound;
      } else {
        EXPECT_NEAR(velocity[i], targets[i], kExact);
        ++free;
      }
    }
  }
  EXPECT_GT(at_bound, 500);
  EXPECT_GT(free, 500);
}

/// A block of 2 kg that falls on a floor at 1 m/s and slides at 3 m/s: coordinates x, z.
TEST(ConstraintProblemTest, SlidingIsBrakedByTheCoefficientTimesTheImpulseOfTheNormal) {
  const Eigen::Matrix2d W = Eigen::Matrix2d::Identity() / 2.0;
  for (const double coefficient : {0.5, 5.0}) {
    ConstraintProblem problem;
    problem.clear();
    const int normal = problem.add(Eigen::Vector2d(0.0, 1.0), 0.0, 0.0, 1e9);
    const int sliding = problem.addSliding(Eigen::Vector2d(1.0, 0.0), coefficient, normal);
    Eigen::VectorXd velocity = Eigen::Vector2d(3.0, -1.0);
    problem.solve(W, velocity);
    EXPECT_NEAR(problem.impulse(normal), 2.0, kExact) << "2 kg at 1 m/s";
    EXPECT_NEAR(problem.impulse(sliding), -std::min(6.0, coefficient * 2.0), kExact);
    EXPECT_NEAR(velocity[0], std::max(0.0, 3.0 - coefficient), kExact);
    EXPECT_NEAR(velocity[1], 0.0, kExact);
  }
}

TEST(ConstraintProblemTest, AJointHeldTwiceIsStillHeld) {
  ConstraintProblem problem;
  problem.clear();
  problem.addJoint(0, 0.0, -0.5, 0.5);
  problem.addJoint(0, 0.0, -1e9, 0.0);
  Eigen::VectorXd velocity = Eigen::VectorXd::Constant(1, 3.0);
  problem.solve(Eigen::MatrixXd::Identity(1, 1), velocity);
  EXPECT_NEAR(velocity[0], 0.0, kExact);
}

}  // namespace
}  // namespace demo_logger
