// The two arms of the package's own urdf folder are what their comments say.

#include <gtest/gtest.h>
#include <urdf_model/model.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

#include "demo_logger/robot/robot_model.h"
#include "src/robot/body_inertia.h"
#include "src/robot/urdf_reader.h"
#include "src/robot/urdf_tree.h"
#include "test/robot/own_arms.h"
#include "test/robot/two_link_by_hand.h"

namespace demo_logger {
namespace {

constexpr double kRounding = 1e-14;

ParsedUrdf parseOwn(const std::string& name) {
  std::ifstream file(ownUrdf(name), std::ios::binary);
  return parseUrdf(std::string{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()});
}

TEST(OwnArmsTest, EveryLinkHasInertiaThatMatterCanHave) {
  for (const std::string name : {"demo_arm", "two_link"}) {
    const ParsedUrdf parsed = parseOwn(name);
    EXPECT_TRUE(parsed.unread_inertia.empty());
    for (const auto& [link_name, link] : parsed.model->links_) {
      EXPECT_EQ(impossibility(inertiaOf(*link)), "") << name << " " << link_name;
    }
  }
}

TEST(OwnArmsTest, TheDemonstrationArmMovesTwentyKilogramsWithFullTensors) {
  const ParsedUrdf parsed = parseOwn("demo_arm");
  double moving_mass = 0.0;
  for (const auto& [name, link] : parsed.model->links_) {
    if (name == "base_link" || name == "tool_tip") continue;
    ASSERT_TRUE(link->inertial) << name;
    moving_mass += link->inertial->mass;
    const bool turned = link->inertial->origin.rotation.w < 0.9999;
    EXPECT_TRUE(turned) << name << ": the inertial frame is turned against the link";
    EXPECT_NE(link->inertial->ixy, 0.0) << name;
    EXPECT_NE(link->inertial->ixz, 0.0) << name;
    EXPECT_NE(link->inertial->iyz, 0.0) << name;
  }
  EXPECT_NEAR(moving_mass, 20.03, 1e-12);

  double lumped_mass = 0.0;
  for (const ArmJoint& joint : describeOwnArm("demo_arm").joints) lumped_mass += joint.body.mass;
  EXPECT_NEAR(lumped_mass, moving_mass, 1e-12) << "tool and sensor box included";
}

TEST(OwnArmsTest, TheDemonstrationArmsJointsAreLimitedDampedAndRubbing) {
  const RobotDescription arm = describeOwnArm("demo_arm");
  EXPECT_EQ(arm.jointNames(),
            (std::vector<std::string>{"joint_1", "joint_2", "joint_3", "joint_4", "joint_5", "joint_6", "joint_7"}));
  for (const ArmJoint& joint : arm.joints) {
    EXPECT_EQ(joint.type, JointType::revolute);
    EXPECT_TRUE(std::isfinite(joint.velocity_limit) && std::isfinite(joint.effort_limit)) << joint.name;
    EXPECT_EQ(joint.lower, -joint.upper) << joint.name;
    EXPECT_GT(joint.damping, 0.0) << joint.name;
    EXPECT_GT(joint.friction, 0.0) << joint.name;
  }
}

TEST(OwnArmsTest, TheDemonstrationArmCanHoldItselfUpWhereverItIsWithHalfItsTorque) {
  const RobotModel model(describeOwnArm("demo_arm"));
  Eigen::VectorXd stretched(7);
  stretched << 0.0, M_PI / 2.0, 0.0, 0.0, 0.0, 0.0, 0.0;  // straight out: the longest lever there is
  const Eigen::VectorXd torque = model.gravity(stretched);
  for (int i = 0; i < 7; ++i) {
    EXPECT_LT(std::abs(torque[i]), 0.5 * model.description().joints[static_cast<std::size_t>(i)].effort_limit) << i;
  }
}

/// The demonstration arm with its rolling joints at 0 is three rods in the x-z plane:
///   0.42 m from shoulder to elbow, 0.39 m from elbow to wrist, 0.269 m from wrist to tip; the shoulder is 0.36 m high.
TEST(OwnArmsTest, TheDemonstrationArmInItsPlaneIsThreeRods) {
  const RobotModel model(describeOwnArm("demo_arm"));
  for (const Eigen::Vector3d& bend : {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(0.5, 1.5, 1.1416),
                                      Eigen::Vector3d(-0.7, 1.2, 0.3), Eigen::Vector3d(1.1, -2.0, -1.0)}) {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(7);
    q[1] = bend[0];
    q[3] = bend[1];
    q[5] = bend[2];
    const double a = bend[0], b = a + bend[1], c = b + bend[2];
    const Eigen::Isometry3d X_base_tip = model.forwardKinematics(q);
    EXPECT_NEAR(X_base_tip.translation().x(), 0.42 * std::sin(a) + 0.39 * std::sin(b) + 0.269 * std::sin(c), kRounding);
    EXPECT_NEAR(X_base_tip.translation().y(), 0.0, kRounding);
    EXPECT_NEAR(X_base_tip.translation().z(), 0.36 + 0.42 * std::cos(a) + 0.39 * std::cos(b) + 0.269 * std::cos(c),
                kRounding);
    const Eigen::Matrix3d expected = Eigen::AngleAxisd(c, Eigen::Vector3d::UnitY()).toRotationMatrix();
    EXPECT_TRUE(X_base_tip.linear().isApprox(expected, kRounding));
  }
}

TEST(OwnArmsTest, TheDemonstrationArmsRollingJointsTurnAboutTheArm) {
  const RobotModel model(describeOwnArm("demo_arm"));
  for (const int roll : {0, 2, 4, 6}) {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(7);
    q[roll] = 0.8;
    const Eigen::Isometry3d X_base_tip = model.forwardKinematics(q);
    EXPECT_TRUE(X_base_tip.translation().isApprox(Eigen::Vector3d(0.0, 0.0, 1.439), kRounding)) << "joint " << roll + 1;
    EXPECT_TRUE(
        X_base_tip.linear().isApprox(Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitZ()).toRotationMatrix(), kRounding));
  }
}

}  // namespace
}  // namespace demo_logger
