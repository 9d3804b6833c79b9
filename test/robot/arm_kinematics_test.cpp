#include "src/robot/arm_kinematics.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/trajectory/error.h"
#include "src/robot/rotation_vector.h"
#include "test/robot/subjects.h"
#include "test/robot/two_link_by_hand.h"

namespace demo_logger {
namespace {

constexpr double kRounding = 1e-12;

TEST(ArmKinematicsTest, EqualsKdlOnEveryArm) {
  for (const Subject& subject : solverSubjects()) {
    const ArmKinematics kinematics(subject.arm);
    const RobotModel kdl(subject.arm);
    std::mt19937_64 generator(1);
    RigidPose alone, pose;
    JacobianMatrix jacobian;
    double worst = 0.0;
    for (int i = 0; i < 500; ++i) {
      const Eigen::VectorXd q = randomPosture(subject.arm, generator);
      kinematics.forward(q, alone);
      kinematics.forward(q, pose, jacobian);
      const Eigen::Isometry3d X_base_tip = kdl.forwardKinematics(q);
      worst = std::max({worst, (X_base_tip.linear() - pose.R).cwiseAbs().maxCoeff(),
                        (X_base_tip.translation() - pose.p).cwiseAbs().maxCoeff(),
                        (kdl.jacobian(q) - jacobian).cwiseAbs().maxCoeff(), (alone.R - pose.R).cwiseAbs().maxCoeff(),
                        (alone.p - pose.p).cwiseAbs().maxCoeff()});
    }
    EXPECT_LT(worst, kRounding) << subject.name;
  }
}

RobotDescription slideAndTurn() {
  return describeRobot(R"(<robot name="slider">
    <link name="base"/><link name="slide"/><link name="hand"/>
    <joint name="lift" type="prismatic"><parent link="base"/><child link="slide"/>
      <origin xyz="0.1 0.2 0.3" rpy="0.3 -0.2 0.5"/><axis xyz="1 2 -2"/>
      <limit lower="-0.5" upper="0.5" velocity="1" effort="1"/></joint>
    <joint name="turn" type="continuous"><parent link="slide"/><child link="hand"/>
      <origin xyz="0 0.4 0" rpy="0 0 1"/><axis xyz="0 0 -1"/></joint>
  </robot>)",
                       {});
}

TEST(ArmKinematicsTest, EqualsKdlForPrismaticJointsAndAxesAgainstZ) {
  const RobotDescription arm = slideAndTurn();
  const ArmKinematics kinematics(arm);
  const RobotModel kdl(arm);
  RigidPose pose;
  JacobianMatrix jacobian;
  for (const Eigen::Vector2d& q :
       {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(0.31, 1.7), Eigen::Vector2d(-0.5, -9.0)}) {
    kinematics.forward(q, pose, jacobian);
    const Eigen::Isometry3d X_base_tip = kdl.forwardKinematics(q);
    EXPECT_LT((X_base_tip.linear() - pose.R).cwiseAbs().maxCoeff(), kRounding);
    EXPECT_LT((X_base_tip.translation() - pose.p).cwiseAbs().maxCoeff(), kRounding);
    EXPECT_LT((kdl.jacobian(q) - jacobian).cwiseAbs().maxCoeff(), kRounding);
  }
}

TEST(ArmKinematicsTest, TheTwoLinkArmReachesNoFurtherThanItsLinksTogether) {
  const ArmKinematics kinematics(describeOwnArm("two_link"));
  EXPECT_NEAR(kinematics.reach(), TwoLinkByHand::l1 + TwoLinkByHand::l2, kRounding);
}

TEST(ArmKinematicsTest, AChainOfMoreJointsThanAnArmHasIsRefusedInASentence) {
  std::string urdf = "<robot name=\"snake\"><link name=\"link0\"/>";
  for (int i = 0; i < 33; ++i) {
    const std::string from = std::to_string(i), to = std::to_string(i + 1);
    urdf += "<link name=\"link" + to + "\"/><joint name=\"joint" + to + "\" type=\"continuous\"><parent link=\"link" +
            from + "\"/><child link=\"link" + to + "\"/><axis xyz=\"0 0 1\"/></joint>";
  }
  const RobotDescription snake = describeRobot(urdf + "</robot>", {});
  try {
    ArmKinematics kinematics(snake);
    FAIL() << "33 joints were accepted";
  } catch (const ModelError& error) {
    EXPECT_STREQ(error.what(),
                 "robot 'snake' has 33 moving joints from base to tip, expected 1 to 32 for inverse kinematics");
  }
}

/// Rodrigues' formula with the two trigonometric functions written so that nothing cancels at small angles.
Eigen::Matrix3d rotationOf(const Eigen::Vector3d& axis, double angle) {
  Eigen::Matrix3d cross;
  cross << 0.0, -axis.z(), axis.y(), axis.z(), 0.0, -axis.x(), -axis.y(), axis.x(), 0.0;
  const double half_sine = std::sin(0.5 * angle);
  return Eigen::Matrix3d::Identity() + std::sin(angle) * cross + 2.0 * half_sine * half_sine * cross * cross;
}

TEST(RotationVectorTest, IsRightFromTinyAnglesToHalfATurn) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1.0, -2.0, 0.5).normalized();
  for (const double angle : {0.0, 1e-15, 1e-12, 1e-9, 5e-7, 1e-6, 1e-3, 1.0, 2.0, 3.0, M_PI - 1e-3, M_PI - 1e-6,
                             M_PI - 5e-7, M_PI - 1e-9, M_PI - 1e-12}) {
    const Eigen::Vector3d vector = rotationVector(rotationOf(axis, angle));
    EXPECT_NEAR(vector.norm(), angle, 1e-15 + 1e-15 * angle) << angle;
    EXPECT_LT((vector - angle * axis).norm(), 2e-15) << angle;
  }
}

TEST(RotationVectorTest, AtExactlyHalfATurnEitherAxisIsRight) {
  for (const Eigen::Vector3d& axis :
       {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(3, -4, 12).normalized()}) {
    const Eigen::Vector3d vector = rotationVector(2.0 * axis * axis.transpose() - Eigen::Matrix3d::Identity());
    EXPECT_NEAR(vector.norm(), M_PI, 1e-15);
    EXPECT_NEAR(std::abs(vector.dot(axis)), M_PI, 1e-14);
  }
}

}  // namespace
}  // namespace demo_logger
