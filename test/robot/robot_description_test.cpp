#include "demo_logger/robot/robot_description.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "demo_logger/trajectory/error.h"
#include "test/robot/own_arms.h"

namespace demo_logger {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string link(const std::string& name, double mass, const std::string& center = "0 0 0") {
  return "<link name='" + name + "'><inertial><origin xyz='" + center + "'/><mass value='" + std::to_string(mass) +
         "'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>";
}

std::string joint(const std::string& name, const std::string& type, const std::string& parent, const std::string& child,
                  const std::string& inside = "") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent + "'/><child link='" + child + "'/>" +
         inside + "</joint>";
}

std::string robot(const std::string& inside) { return "<robot name='r'>" + inside + "</robot>"; }

const std::string kLimit = "<limit lower='-1' upper='2' velocity='3' effort='4'/>";

/// base -lift- hand, with a finger sliding along x on the hand.
std::string handWithFinger(const std::string& finger_inside) {
  return robot(link("base", 9) + link("hand", 2) + link("finger", 1) +
               joint("lift", "revolute", "base", "hand", "<axis xyz='0 0 1'/>" + kLimit) +
               joint("slide", "prismatic", "hand", "finger", "<axis xyz='1 0 0'/>" + finger_inside));
}

RobotDescription describeHand(const std::string& urdf, const std::map<std::string, double>& locked = {}) {
  DescriptionOptions options;
  options.base = "base";
  options.tip = "hand";
  options.locked = locked;
  return describeRobot(urdf, options);
}

std::string errorOf(const std::string& urdf, const DescriptionOptions& options) {
  try {
    describeRobot(urdf, options);
  } catch (const ModelError& error) {
    return error.what();
  }
  return "no error";
}

TEST(RobotDescriptionTest, LumpsASideBranchIntoTheLinkThatCarriesIt) {
  const RobotDescription arm = describeHand(handWithFinger("<origin xyz='0.3 0 0'/>" + kLimit));
  ASSERT_EQ(arm.joints.size(), 1u);
  EXPECT_DOUBLE_EQ(arm.joints[0].body.mass, 3.0);
  EXPECT_NEAR(arm.joints[0].body.center.x(), 0.1, 1e-15) << "(2 kg at 0 m + 1 kg at 0.3 m) / 3 kg";
  EXPECT_NEAR(arm.joints[0].body.inertia(1, 1), 2.0 + 2.0 / 3.0 * 0.3 * 0.3, 1e-15)
      << "own 1 + 1 kg m², and the reduced mass 2·1/3 kg at 0.3 m";
}

TEST(RobotDescriptionTest, HoldsASideJointAtZeroOrTheNearestLimitOrWhereTold) {
  const std::string around_zero = "<limit lower='-1' upper='2' velocity='3' effort='4'/>";
  const std::string above_zero = "<limit lower='0.6' upper='2' velocity='3' effort='4'/>";
  const std::string below_zero = "<limit lower='-2' upper='-0.9' velocity='3' effort='4'/>";
  EXPECT_NEAR(describeHand(handWithFinger(around_zero)).joints[0].body.center.x(), 0.0, 1e-15);
  EXPECT_NEAR(describeHand(handWithFinger(above_zero)).joints[0].body.center.x(), 0.2, 1e-15);
  EXPECT_NEAR(describeHand(handWithFinger(below_zero)).joints[0].body.center.x(), -0.3, 1e-15);
  EXPECT_NEAR(describeHand(handWithFinger(around_zero), {{"slide", 1.5}}).joints[0].body.center.x(), 0.5, 1e-15);
}

TEST(RobotDescriptionTest, AMimicJointFollowsItsMasterByMultiplierAndOffset) {
  const std::string urdf =
      robot(link("base", 9) + link("hand", 2) + link("finger", 1) + link("thumb", 1) +
            joint("lift", "revolute", "base", "hand", "<axis xyz='0 0 1'/>" + kLimit) +
            joint("slide", "prismatic", "hand", "finger", "<axis xyz='1 0 0'/>" + kLimit) +
            joint("follow", "prismatic", "hand", "thumb",
                  "<axis xyz='0 1 0'/>" + kLimit + "<mimic joint='slide' multiplier='-2' offset='0.4'/>"));
  const Eigen::Vector3d at_zero = describeHand(urdf).joints[0].body.center;
  EXPECT_TRUE(at_zero.isApprox(Eigen::Vector3d(0.0, 0.4 / 4.0, 0.0), 1e-15)) << at_zero.transpose();
  const Eigen::Vector3d moved = describeHand(urdf, {{"slide", 0.8}}).joints[0].body.center;
  EXPECT_TRUE(moved.isApprox(Eigen::Vector3d(0.8 / 4.0, (-2.0 * 0.8 + 0.4) / 4.0, 0.0), 1e-15)) << moved.transpose();
}

TEST(RobotDescriptionTest, MimicsOfMimicsFollowTheFirstMaster) {
  const std::string urdf = robot(
      link("base", 9) + link("hand", 2) + link("a", 1) + link("b", 1) + link("c", 1) +
      joint("lift", "revolute", "base", "hand", "<axis xyz='0 0 1'/>" + kLimit) +
      joint("ja", "prismatic", "hand", "a", "<axis xyz='1 0 0'/>" + kLimit + "<mimic joint='jb' multiplier='3'/>") +
      joint("jb", "prismatic", "hand", "b",
            "<axis xyz='0 1 0'/>" + kLimit + "<mimic joint='jc' multiplier='2' offset='0.1'/>") +
      joint("jc", "prismatic", "hand", "c", "<axis xyz='0 0 1'/>" + kLimit));
  const Eigen::Vector3d center = describeHand(urdf, {{"jc", 0.5}}).joints[0].body.center;
  EXPECT_TRUE(center.isApprox(Eigen::Vector3d(3.0 * (2.0 * 0.5 + 0.1), 2.0 * 0.5 + 0.1, 0.5) / 5.0, 1e-15));
  const Eigen::Vector3d own_place = describeHand(urdf, {{"jc", 0.5}, {"jb", 0.2}}).joints[0].body.center;
  EXPECT_TRUE(own_place.isApprox(Eigen::Vector3d(3.0 * 0.2, 0.2, 0.5) / 5.0, 1e-15)) << "a given place wins";
}

/// base -lift- hand, and on the hand two fingers of which the second mimics the first.
std::string handWithTwoFingers() {
  return robot(link("base", 9) + link("hand", 2) + link("left", 1) + link("right", 1) +
               joint("lift", "revolute", "base", "hand", "<axis xyz='0 0 1'/>" + kLimit) +
               joint("slide", "prismatic", "hand", "left", "<axis xyz='1 0 0'/>" + kLimit) +
               joint("follow", "prismatic", "hand", "right",
                     "<axis xyz='0 1 0'/>" + kLimit + "<mimic joint='slide' multiplier='-2' offset='0.4'/>"));
}

TEST(RobotDescriptionTest, AMimicJointInTheChainIsLockedWhereItsMasterBesideIs) {
  DescriptionOptions options;
  options.tip = "right";
  options.locked = {{"slide", 0.8}};
  const RobotDescription arm = describeRobot(handWithTwoFingers(), options);
  EXPECT_EQ(arm.jointNames(), std::vector<std::string>{"lift"}) << "one that follows never moves by itself";
  EXPECT_TRUE(arm.X_lastlink_tip.translation().isApprox(Eigen::Vector3d(0.0, -2.0 * 0.8 + 0.4, 0.0), 1e-15));
  options.locked = {{"follow", 0.3}};
  EXPECT_TRUE(describeRobot(handWithTwoFingers(), options)
                  .X_lastlink_tip.translation()
                  .isApprox(Eigen::Vector3d(0.0, 0.3, 0.0), 1e-15));
}

TEST(RobotDescriptionTest, AMimicJointBesideTheChainIsHeldWhereItsMasterIsAtZero) {
  DescriptionOptions options;
  options.tip = "left";
  const RobotDescription arm = describeRobot(handWithTwoFingers(), options);
  EXPECT_EQ(arm.jointNames(), (std::vector<std::string>{"lift", "slide"}));
  EXPECT_NEAR(arm.joints[0].body.center.y(), 0.4 / 3.0, 1e-15) << "1 of 3 kg at the offset";
  EXPECT_FALSE(arm.has_inertia) << "it moves with the arm";
}

TEST(RobotDescriptionTest, MergesFixedJointsInsideTheChainAndPastTheTip) {
  const std::string urdf =
      robot(link("base", 9) + link("a", 2) + link("flange", 1) + link("b", 4) + link("tool", 3) + link("past", 5) +
            joint("j1", "revolute", "base", "a", "<origin xyz='0 0 0.5'/><axis xyz='0 0 1'/>" + kLimit) +
            joint("f1", "fixed", "a", "flange", "<origin xyz='0 0 0.25'/>") +
            joint("j2", "revolute", "flange", "b", "<origin xyz='0 0 0.125'/><axis xyz='0 2 0'/>" + kLimit) +
            joint("f2", "fixed", "b", "tool", "<origin xyz='0 0 1'/>") + joint("f3", "fixed", "tool", "past"));
  DescriptionOptions options;
  options.tip = "tool";
  const RobotDescription arm = describeRobot(urdf, options);

  EXPECT_EQ(arm.base, "base") << "an empty base is the root";
  ASSERT_EQ(arm.jointNames(), (std::vector<std::string>{"j1", "j2"}));
  EXPECT_DOUBLE_EQ(arm.joints[0].body.mass, 3.0);
  EXPECT_DOUBLE_EQ(arm.joints[1].body.mass, 12.0) << "b, tool, and what hangs past the tip";
  EXPECT_TRUE(arm.joints[1].X_parent_joint.translation().isApprox(Eigen::Vector3d(0.0, 0.0, 0.375), 1e-15));
  EXPECT_TRUE(arm.joints[1].axis.isApprox(Eigen::Vector3d::UnitY(), 1e-15)) << "an axis is a direction";
  EXPECT_TRUE(arm.X_lastlink_tip.translation().isApprox(Eigen::Vector3d(0.0, 0.0, 1.0), 1e-15));

  options.tip.clear();
  EXPECT_EQ(describeRobot(urdf, options).tip, "past") << "an empty tip is the only leaf";
}

TEST(RobotDescriptionTest, GravityIsDownInTheRootSeenFromTheBase) {
  const std::string urdf = robot(link("world", 1) + link("torso", 1) + link("base", 1) + link("hand", 1) +
                                 joint("mount", "fixed", "world", "torso", "<origin rpy='1.5707963267948966 0 0'/>") +
                                 joint("lean", "revolute", "torso", "base", "<axis xyz='0 0 1'/>" + kLimit) +
                                 joint("lift", "revolute", "base", "hand", "<axis xyz='0 0 1'/>" + kLimit));
  // The mount turns the torso's y axis to the world's z: down is −y there. Leaning by φ about z then turns it on.
  EXPECT_TRUE(describeHand(urdf).gravity.isApprox(Eigen::Vector3d(0.0, -9.81, 0.0), 1e-15));
  const double lean = 0.7;
  EXPECT_TRUE(describeHand(urdf, {{"lean", lean}})
                  .gravity.isApprox(-9.81 * Eigen::Vector3d(std::sin(lean), std::cos(lean), 0.0), 1e-14));
  DescriptionOptions moon;
  moon.tip = "hand";
  moon.gravity = 1.62;
  EXPECT_TRUE(describeRobot(urdf, moon).gravity.isApprox(Eigen::Vector3d(0.0, 0.0, -1.62), 1e-15));
}

TEST(RobotDescriptionTest, ReadsTypesLimitsAndDynamics) {
  const std::string urdf =
      robot(link("base", 1) + link("a", 1) + link("b", 1) + link("hand", 1) +
            joint("j1", "revolute", "base", "a",
                  kLimit + "<safety_controller k_velocity='1' soft_lower_limit='-0.5' soft_upper_limit='5'/>" +
                      "<dynamics damping='0.7' friction='0.2'/>") +
            joint("j2", "continuous", "a", "b", "<safety_controller k_velocity='1'/>") +
            joint("j3", "prismatic", "b", "hand",
                  "<limit lower='-1' upper='2' velocity='0' effort='0'/><safety_controller k_velocity='1'/>"));
  const RobotDescription arm = describeHand(urdf);

  EXPECT_EQ(arm.joints[0].type, JointType::revolute);
  EXPECT_EQ(arm.joints[0].lower, -0.5) << "the soft limit is the narrower one";
  EXPECT_EQ(arm.joints[0].upper, 2.0) << "the hard limit is the narrower one";
  EXPECT_EQ(arm.joints[0].velocity_limit, 3.0);
  EXPECT_EQ(arm.joints[0].effort_limit, 4.0);
  EXPECT_EQ(arm.joints[0].damping, 0.7);
  EXPECT_EQ(arm.joints[0].friction, 0.2);
  EXPECT_TRUE(arm.joints[0].axis.isApprox(Eigen::Vector3d::UnitX())) << "URDF's default axis";

  EXPECT_EQ(arm.joints[1].type, JointType::continuous);
  EXPECT_EQ(arm.joints[1].lower, -kInfinity);
  EXPECT_EQ(arm.joints[1].upper, kInfinity);
  EXPECT_EQ(arm.joints[1].velocity_limit, kInfinity);

  EXPECT_EQ(arm.joints[2].type, JointType::prismatic);
  EXPECT_EQ(arm.joints[2].lower, -1.0) << "a safety controller without soft limits narrows nothing";
  EXPECT_EQ(arm.joints[2].upper, 2.0);
  EXPECT_EQ(arm.joints[2].velocity_limit, kInfinity) << "0 means that none was stated";
  EXPECT_EQ(arm.joints[2].effort_limit, kInfinity);
}

TEST(RobotDescriptionTest, ALoadAtTheTipJoinsTheLastBody) {
  RobotDescription arm = describeHand(handWithFinger(kLimit));
  arm.X_lastlink_tip = Eigen::Translation3d(0.0, 0.0, 0.5);
  BodyInertia load;
  load.mass = 3.0;
  load.center = {0.0, 0.0, 0.1};
  const RobotDescription loaded = withLoad(arm, load);
  EXPECT_DOUBLE_EQ(loaded.joints[0].body.mass, 6.0);
  EXPECT_NEAR(loaded.joints[0].body.center.z(), 0.3, 1e-15) << "3 kg at 0 m, 3 kg at 0.6 m";
  EXPECT_NEAR(loaded.joints[0].body.inertia(0, 0), 2.0 + 1.5 * 0.36, 1e-14);

  load.mass = -1.0;
  try {
    withLoad(arm, load);
    FAIL() << "a negative load was accepted";
  } catch (const ModelError& error) {
    EXPECT_STREQ(error.what(), "the load at tip 'hand' has mass -1 kg, expected a positive one");
  }
}

TEST(RobotDescriptionTest, ALoadThatNoArmMovesIsRefused) {
  const RobotDescription arm = describeOwnArm("two_link");
  const auto messageOf = [&](const BodyInertia& load) -> std::string {
    try {
      withLoad(arm, load);
    } catch (const ModelError& error) {
      return error.what();
    }
    return "";
  };
  BodyInertia load;
  load.mass = 1e20;
  EXPECT_EQ(messageOf(load), "the load at tip 'tool_tip' has a mass of 1e+20 kg, expected at most 1000 kg");
  load.mass = 0.5;
  load.center.x() = 1e9;
  EXPECT_EQ(
      messageOf(load),
      "the load at tip 'tool_tip' reaches 1e+09 m away with moments of inertia up to 0 kg m², expected at most 10 m "
      "and 100000 kg m²");
}

TEST(RobotDescriptionTest, KeepsTheHashOfTheVeryTextItRead) {
  const std::string urdf = handWithFinger(kLimit);
  EXPECT_EQ(describeHand(urdf).urdf_sha256.size(), 64u);
  EXPECT_EQ(describeHand(urdf).urdf_sha256, describeHand(urdf).urdf_sha256);
  EXPECT_NE(describeHand(urdf).urdf_sha256, describeHand(urdf + "\n").urdf_sha256);
}

TEST(RobotDescriptionTest, LockedNamesMustBeJointsBesideTheArm) {
  DescriptionOptions options;
  options.tip = "hand";
  options.locked = {{"slid", 0.0}};
  EXPECT_EQ(errorOf(handWithFinger(kLimit), options),
            "robot description: no joint 'slid' to lock in robot 'r'; the nearest names are 'slide', 'lift'");
  options.locked = {{"lift", 0.0}};
  EXPECT_EQ(errorOf(handWithFinger(kLimit), options),
            "robot description: joint 'lift' cannot be locked: it is one of the arm's moving joints");
  options.locked = {{"slide", std::numeric_limits<double>::quiet_NaN()}};
  EXPECT_EQ(errorOf(handWithFinger(kLimit), options),
            "robot description: joint 'slide' cannot be locked at nan, expected a finite position in rad or m");
}

}  // namespace
}  // namespace demo_logger
