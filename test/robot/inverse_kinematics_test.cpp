#include "demo_logger/robot/inverse_kinematics.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/trajectory/error.h"
#include "test/robot/counted_allocations.h"
#include "test/robot/error_of.h"
#include "test/robot/pose_by_hand.h"
#include "test/robot/subjects.h"
#include "test/robot/two_link_by_hand.h"

namespace demo_logger {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kFine = 1e-9;  // [m] and [rad]

/// How far `q` is out of the limits [rad or m]; 0 within.
double beyondLimits(const RobotDescription& arm, const Eigen::VectorXd& q) {
  double beyond = 0.0;
  for (std::size_t i = 0; i < arm.joints.size(); ++i) {
    const double value = q[static_cast<Eigen::Index>(i)];
    beyond = std::max({beyond, arm.joints[i].lower - value, value - arm.joints[i].upper});
  }
  return beyond;
}

// The two-link arm has a closed form: the elbow angle by the law of cosines, twice, and the shoulder from it.
struct TwoLinkSolutions {
  explicit TwoLinkSolutions(const Eigen::Vector3d& tip) {
    const double l1 = TwoLinkByHand::l1, l2 = TwoLinkByHand::l2;
    const double cosine = (tip.x() * tip.x() + tip.z() * tip.z() - l1 * l1 - l2 * l2) / (2.0 * l1 * l2);
    const double elbow = std::acos(cosine);
    for (const double q2 : {elbow, -elbow}) {
      const double q1 = std::atan2(tip.x(), tip.z()) - std::atan2(l2 * std::sin(q2), l1 + l2 * std::cos(q2));
      both.emplace_back(q1, q2);
    }
  }
  std::vector<Eigen::Vector2d> both;
};

/// On this arm a position with an orientation leaves one solution, so the tip's own orientation picks the branch.
TEST(InverseKinematicsTest, PosesReachedWithEveryJointAtALimitAreSolved) {
  for (const Subject& subject : solverSubjects()) {
    const RobotDescription& arm = subject.arm;
    const RobotModel kdl(arm);
    const InverseKinematics solver(arm);
    Eigen::VectorXd corner(static_cast<Eigen::Index>(arm.joints.size())), q;
    for (unsigned which = 0; which < 64; ++which) {
      for (std::size_t i = 0; i < arm.joints.size(); ++i) {
        const ArmJoint& joint = arm.joints[i];
        const double limit = (which >> i) % 2 == 0 ? joint.lower : joint.upper;
        corner[static_cast<Eigen::Index>(i)] = std::isfinite(limit) ? limit : 1.0;
      }
      EXPECT_TRUE(solver.solve(kdl.forwardKinematics(corner), solver.middle(), q).solved)
          << subject.name << ", corner " << which;
    }
  }
}

TEST(InverseKinematicsTest, TheTwoLinkArmGetsItsClosedFormSolution) {
  const InverseKinematics solver(describeOwnArm("two_link"));
  const Eigen::Vector2d straight(0.0, 0.0);
  for (const Eigen::Vector3d& tip : {Eigen::Vector3d(0.5, 0.0, 0.3), Eigen::Vector3d(-0.2, 0.0, 0.6),
                                     Eigen::Vector3d(0.1, 0.0, -0.7), Eigen::Vector3d(0.12, 0.0, 0.0)}) {
    for (const Eigen::Vector2d& expected : TwoLinkSolutions(tip).both) {
      Eigen::Isometry3d X_base_tip = Eigen::Isometry3d::Identity();
      X_base_tip.translation() = tip;
      X_base_tip.linear() = Eigen::AngleAxisd(expected.sum(), Eigen::Vector3d::UnitY()).matrix();
      Eigen::VectorXd q;
      const Solution solution = solver.solve(X_base_tip, straight, q);
      EXPECT_TRUE(solution.solved);
      for (int i = 0; i < 2; ++i) EXPECT_NEAR(std::remainder(q[i] - expected[i], 2.0 * M_PI), 0.0, 1e-8);
    }
  }
}

TEST(InverseKinematicsTest, JointsOfSeveralTurnsReturnTheTurnNearestToTheSeed) {
  const RobotDescription arm = describeOwnArm("two_link");  // limits: two turns either way
  const InverseKinematics solver(arm);
  const Eigen::Vector2d goal(0.4, 1.1);
  const Eigen::Isometry3d X_base_tip = RobotModel(arm).forwardKinematics(goal);
  const double turn = 2.0 * M_PI;
  for (const Eigen::Vector2d& turns : {Eigen::Vector2d(0, 0), Eigen::Vector2d(1, -1), Eigen::Vector2d(-2, 1)}) {
    Eigen::VectorXd q;
    ASSERT_TRUE(solver.solve(X_base_tip, goal + turn * turns + Eigen::Vector2d(0.3, -0.3), q).solved);
    EXPECT_NEAR(q[0], goal[0] + turn * turns[0], 1e-8);
    EXPECT_NEAR(q[1], goal[1] + turn * turns[1], 1e-8);
  }
  Eigen::VectorXd q;
  ASSERT_TRUE(solver.solve(X_base_tip, Eigen::Vector2d(12.5, 0.0), q).solved);
  EXPECT_NEAR(q[0], goal[0] + turn, 1e-8) << "0.4 + 4 π lies beyond the limit of 4 π: one turn less";
}

TEST(InverseKinematicsTest, SolvesEveryReachablePoseOfEveryArmWithinLimits) {
  constexpr int kPoses = 150;
  SolveOptions options;
  options.tolerance = kFine;
  for (const Subject& subject : solverSubjects()) {
    const InverseKinematics solver(subject.arm);
    const RobotModel kdl(subject.arm);
    std::mt19937_64 generator(11);
    for (int i = 0; i < kPoses; ++i) {
      const Eigen::Isometry3d X_base_tip = kdl.forwardKinematics(randomPosture(subject.arm, generator));
      for (const Eigen::VectorXd& seed : {solver.middle(), randomPosture(subject.arm, generator)}) {
        Eigen::VectorXd q;
        const Solution solution = solver.solve(X_base_tip, seed, q, options);
        EXPECT_TRUE(solution.solved) << subject.name << " pose " << i;
        EXPECT_EQ(beyondLimits(subject.arm, q), 0.0) << subject.name << " pose " << i;
        EXPECT_LE(poseDistance(kdl.forwardKinematics(q), X_base_tip), kFine + 1e-13) << subject.name << " pose " << i;
      }
    }
  }
}

TEST(InverseKinematicsTest, RangesFarFromZeroAreSearchedWhole) {
  SolveOptions options;
  options.tolerance = kFine;
  for (const auto& [lower, upper] : {std::pair(3.2, 6.2), std::pair(-6.2, -3.2), std::pair(1.0, 5.0)}) {
    RobotDescription arm = describeOwnArm("demo_arm");
    for (ArmJoint& joint : arm.joints) {
      joint.lower = lower;
      joint.upper = upper;
    }
    const InverseKinematics solver(arm);
    const RobotModel kdl(arm);
    std::mt19937_64 generator(12);
    for (int i = 0; i < 100; ++i) {
      const Eigen::Isometry3d X_base_tip = kdl.forwardKinematics(randomPosture(arm, generator));
      Eigen::VectorXd q;
      const Solution solution = solver.solve(X_base_tip, randomPosture(arm, generator), q, options);
      EXPECT_TRUE(solution.solved) << lower << " to " << upper << ", pose " << i;
      EXPECT_EQ(beyondLimits(arm, q), 0.0) << lower << " to " << upper << ", pose " << i;
    }
  }
}

RC_GTEST_PROP(InverseKinematicsProperty, ASeedCloseToASolutionIsNotLeftForAnotherBranch, ()) {
  static const RobotDescription arm = describeOwnArm("demo_arm");
  static const InverseKinematics solver(arm);
  static const RobotModel kdl(arm);
  std::mt19937_64 generator(*rc::gen::arbitrary<std::uint64_t>());
  Eigen::VectorXd goal = randomPosture(arm, generator);
  goal[3] = 1.5;  // elbow and wrist bent: where nothing is singular a small move of the tip is one of the joints
  goal[5] = 1.2;
  std::uniform_real_distribution<double> nudge(-0.03, 0.03);
  Eigen::VectorXd seed = goal;
  for (double& value : seed) value += nudge(generator);
  Eigen::VectorXd q;
  RC_ASSERT(solver.solve(kdl.forwardKinematics(goal), seed, q).solved);
  RC_ASSERT((q - seed).cwiseAbs().maxCoeff() < 0.3);
}

TEST(InverseKinematicsTest, FurtherStartsOnlyBringTheResultNearerToTheSeed) {
  const RobotDescription arm = describeOwnArm("demo_arm");
  const InverseKinematics solver(arm);
  const RobotModel kdl(arm);
  std::mt19937_64 generator(5);
  int nearer = 0;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Isometry3d X_base_tip = kdl.forwardKinematics(randomPosture(arm, generator));
    const Eigen::VectorXd seed = randomPosture(arm, generator);
    double before = std::numeric_limits<double>::infinity();
    for (const int further : {0, 10}) {
      SolveOptions options;
      options.further_starts = further;
      Eigen::VectorXd q;
      ASSERT_TRUE(solver.solve(X_base_tip, seed, q, options).solved);
      const double move = (q - seed).cwiseAbs().maxCoeff();
      EXPECT_LE(move, before);
      if (move < before - 0.01 && further > 0) ++nearer;
      before = move;
    }
  }
  EXPECT_GT(nearer, 30) << "most random poses of seven joints have nearer branches than the first one found";
}

TEST(InverseKinematicsTest, ATargetOutOfReachFailsWithTheDistanceToWhatCanBeReached) {
  const RobotDescription arm = describeOwnArm("two_link");
  const InverseKinematics solver(arm);
  Eigen::Isometry3d above = Eigen::Isometry3d::Identity();
  above.translation() = Eigen::Vector3d(0.0, 0.0, 1.2);
  Eigen::VectorXd q;
  const Solution solution = solver.solve(above, Eigen::Vector2d(0.7, -0.2), q);
  EXPECT_FALSE(solution.solved);
  EXPECT_NEAR(solution.residual, 1.2 - TwoLinkByHand::l1 - TwoLinkByHand::l2, 1e-3) << "straight up is the nearest";
  EXPECT_EQ(beyondLimits(arm, q), 0.0);
  EXPECT_LT(solution.iterations, 5000);
}

TEST(InverseKinematicsTest, AnUnreachableOrientationEndsAfterTheIterationsAllowed) {
  const InverseKinematics solver(describeOwnArm("two_link"));
  Eigen::Isometry3d sideways = Eigen::Isometry3d::Identity();
  sideways.translation() = Eigen::Vector3d(0.5, 0.0, 0.3);
  sideways.linear() = Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitX()).matrix();  // out of the arm's plane
  SolveOptions options;
  options.most_iterations = 300;
  Eigen::VectorXd q;
  const Solution solution = solver.solve(sideways, Eigen::Vector2d(0.1, 0.1), q, options);
  EXPECT_FALSE(solution.solved);
  EXPECT_EQ(solution.iterations, 300);
  EXPECT_GE(solution.residual, 0.5 * M_PI - 1e-9) << "a plane's rotations come no nearer than a quarter turn";
}

TEST(InverseKinematicsTest, WhoeverIsOutOfTimeGetsTheBestSoFar) {
  const InverseKinematics solver(describeOwnArm("two_link"));
  Eigen::Isometry3d sideways = Eigen::Isometry3d::Identity();
  sideways.linear() = Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitX()).matrix();
  SolveOptions options;
  int asked = 0;
  options.out_of_time = [&asked] { return ++asked == 5; };
  Eigen::VectorXd q;
  const Solution solution = solver.solve(sideways, Eigen::Vector2d(0.1, 0.1), q, options);
  EXPECT_EQ(solution.starts, 5);
  EXPECT_TRUE(q.allFinite());
}

TEST(InverseKinematicsTest, WhatIsNotAPoseIsRefusedAtOnce) {
  const InverseKinematics solver(describeOwnArm("demo_arm"));
  const Eigen::VectorXd seed = solver.middle();
  Eigen::Isometry3d not_a_number = Eigen::Isometry3d::Identity();
  not_a_number.translation().x() = kNan;
  Eigen::Isometry3d stretched = Eigen::Isometry3d::Identity();
  stretched.linear() *= 1.05;  // what a quaternion makes that is not normalised
  Eigen::Isometry3d mirrored = Eigen::Isometry3d::Identity();
  mirrored.linear()(2, 2) = -1.0;
  Eigen::Isometry3d nothing = Eigen::Isometry3d::Identity();
  nothing.linear().setZero();
  Eigen::Isometry3d beyond_computing = Eigen::Isometry3d::Identity();
  beyond_computing.translation().x() = 1e155;  // its square is none
  for (const Eigen::Isometry3d& target : {not_a_number, stretched, mirrored, nothing, beyond_computing}) {
    Eigen::VectorXd q;
    const Solution solution = solver.solve(target, seed, q);
    EXPECT_FALSE(solution.solved);
    EXPECT_EQ(solution.iterations, 0);
    EXPECT_TRUE(std::isnan(solution.residual));
    EXPECT_TRUE(q.array().isNaN().all());
  }
  Eigen::VectorXd bad_seed = seed, q;
  bad_seed[2] = kNan;
  EXPECT_FALSE(solver.solve(Eigen::Isometry3d::Identity(), bad_seed, q).solved);
}

TEST(InverseKinematicsTest, ASeedOutOfLimitsStartsAtThem) {
  const RobotDescription arm = describeOwnArm("demo_arm");
  const InverseKinematics solver(arm);
  const Eigen::VectorXd far = Eigen::VectorXd::Constant(7, 1e6);
  Eigen::VectorXd at_limits(7), q_far, q_limits;
  for (int i = 0; i < 7; ++i) at_limits[i] = arm.joints[static_cast<std::size_t>(i)].upper;
  const Eigen::Isometry3d X_base_tip = RobotModel(arm).forwardKinematics(solver.middle());
  EXPECT_TRUE(solver.solve(X_base_tip, far, q_far).solved);
  EXPECT_TRUE(solver.solve(X_base_tip, at_limits, q_limits).solved);
  EXPECT_EQ(q_far, q_limits);
}

TEST(InverseKinematicsTest, SeedsOfTheWrongSizeAndSenselessOptionsAreSaidInASentence) {
  const InverseKinematics solver(describeOwnArm("two_link"));
  Eigen::VectorXd q;
  EXPECT_EQ(errorOf([&] { solver.solve(Eigen::Isometry3d::Identity(), Eigen::VectorXd::Zero(3), q); }),
            "robot 'two_link': the seed has 3 values, expected one for each of its 2 joints");
  SolveOptions options;
  options.tolerance = -1.0;
  EXPECT_EQ(errorOf([&] { solver.solve(Eigen::Isometry3d::Identity(), Eigen::VectorXd::Zero(2), q, options); }),
            "inverse kinematics: tolerance is -1, iterations 10000, further starts 1; expected a positive "
            "tolerance, at least one iteration, and no negative count");
}

TEST(InverseKinematicsTest, NoCallAllocatesAndEveryRunGivesTheSameBits) {
  const RobotDescription arm = describeOwnArm("demo_arm");
  const InverseKinematics first(arm), second(arm);
  const RobotModel kdl(arm);
  std::mt19937_64 generator(3);
  std::vector<Eigen::Isometry3d, Eigen::aligned_allocator<Eigen::Isometry3d>> targets;
  std::vector<Eigen::VectorXd> results;
  for (int i = 0; i < 200; ++i) targets.push_back(kdl.forwardKinematics(randomPosture(arm, generator)));
  targets.push_back(Eigen::Isometry3d::Identity() * Eigen::Translation3d(9.0, 0.0, 0.0));
  const Eigen::VectorXd seed = first.middle();
  Eigen::VectorXd q(7);
  const std::size_t before = allocation_count;
  for (const Eigen::Isometry3d& target : targets) first.solve(target, seed, q);
  if (kAllocationsAreCounted) {
    EXPECT_EQ(allocation_count, before);
  }

  for (const Eigen::Isometry3d& target : targets) {
    first.solve(target, seed, q);
    results.push_back(q);
  }
  std::reverse(targets.begin(), targets.end());  // another solver, another order: nothing is remembered
  std::reverse(results.begin(), results.end());
  for (std::size_t i = 0; i < targets.size(); ++i) {
    second.solve(targets[i], seed, q);
    EXPECT_EQ(q, results[i]);
  }
}

TEST(InverseKinematicsTest, OneSolverServesSeveralThreads) {
  const RobotDescription arm = describeOwnArm("demo_arm");
  const InverseKinematics solver(arm);
  const RobotModel kdl(arm);
  std::mt19937_64 generator(4);
  std::vector<Eigen::Isometry3d, Eigen::aligned_allocator<Eigen::Isometry3d>> targets;
  for (int i = 0; i < 300; ++i) targets.push_back(kdl.forwardKinematics(randomPosture(arm, generator)));
  std::vector<std::vector<Eigen::VectorXd>> results(3, std::vector<Eigen::VectorXd>(targets.size()));
  std::vector<std::thread> threads;
  for (auto& own : results) {
    threads.emplace_back([&] {
      for (std::size_t i = 0; i < targets.size(); ++i) solver.solve(targets[i], solver.middle(), own[i]);
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

}  // namespace
}  // namespace demo_logger
