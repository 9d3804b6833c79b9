// Every fault of a URDF that a user can meet, and the one sentence that he reads.

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "demo_logger/robot/robot_description.h"
#include "demo_logger/robot/robot_model.h"
#include "demo_logger/trajectory/error.h"
#include "test/robot/own_arms.h"

namespace demo_logger {
namespace {

const std::string kInertia = "<inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>";
const std::string kLimit = "<limit lower='-1' upper='1' velocity='1' effort='1'/>";

std::string sentenceOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

std::string faultOf(const std::string& urdf, const std::string& base = "", const std::string& tip = "") {
  DescriptionOptions options;
  options.base = base;
  options.tip = tip;
  return sentenceOf([&] { describeRobot(urdf, options); });
}

/// base - j1 - hand, with what a test wants to have in joint and hand, and beside them.
std::string simpleArm(const std::string& type, const std::string& in_joint, const std::string& in_hand = "",
                      const std::string& beside = "") {
  return "<robot name='r'><link name='base'/><link name='hand'>" + in_hand + "</link><joint name='j1' type='" + type +
         "'><parent link='base'/><child link='hand'/>" + in_joint + "</joint>" + beside + "</robot>";
}

TEST(UrdfFaultsTest, AJointWithoutARangeIsDoubtful) {
  const auto warningsOf = [](const std::string& type, const std::string& limit) {
    return describeRobot(simpleArm(type, limit), {}).warnings;
  };
  const std::string no_range = "<limit velocity='1' effort='1'/>";
  EXPECT_EQ(warningsOf("revolute", no_range),
            (std::vector<std::string>{"robot description: joint 'j1' cannot move, its limits are 0 to 0 rad; give "
                                      "<limit> lower and upper, or the joint the type continuous if it turns without "
                                      "end"}));
  EXPECT_EQ(warningsOf("prismatic", "<limit lower='0.2' upper='0.2' velocity='1' effort='1'/>"),
            (std::vector<std::string>{"robot description: joint 'j1' cannot move, its limits are 0.2 to 0.2 m; give "
                                      "<limit> lower and upper"}));
  EXPECT_EQ(warningsOf("continuous", no_range), std::vector<std::string>{});
  EXPECT_EQ(warningsOf("revolute", kLimit), std::vector<std::string>{});
}

TEST(UrdfFaultsTest, ADoctypeIsPassedOverButNotItsEntities) {
  const std::string arm = simpleArm("revolute", kLimit);
  EXPECT_EQ(faultOf("<?xml version='1.0'?>\n<!DOCTYPE robot>\n" + arm), "no error");
  EXPECT_EQ(faultOf("<?xml version='1.0'?>\n<!DOCTYPE robot [<!ENTITY reach '0.3'>]>\n" + arm),
            "robot description: the URDF declares entities in its <!DOCTYPE [...]>, which readers of URDF do not know; "
            "remove the declaration and write out what it stands for");
  EXPECT_EQ(faultOf("<!DOCTYPE robot"),
            "robot description: not a valid URDF: Could not find the 'robot' element in the xml file");
}

TEST(UrdfFaultsTest, AFileThatIsNotThereOrNotAFile) {
  EXPECT_EQ(sentenceOf([] { describeRobotFile("/nonexistent/arm.urdf", {}); }),
            "/nonexistent/arm.urdf: no such file, expected a robot description (URDF)");
  const std::string folder = std::filesystem::temp_directory_path();
  EXPECT_EQ(sentenceOf([&] { describeRobotFile(folder, {}); }),
            folder + ": is a directory, expected a robot description (URDF)");
  EXPECT_THROW(describeRobotFile("/nonexistent/arm.urdf", {}), FileError);
}

TEST(UrdfFaultsTest, TextThatIsNoUrdf) {
  EXPECT_EQ(faultOf(" \n"), "robot description: the URDF text is empty");
  EXPECT_EQ(faultOf("<robot name='r'><xacro:arm/></robot>"),
            "robot description: this is a xacro file, not a URDF; expand it first: xacro FILE > robot.urdf");
  EXPECT_EQ(faultOf("<robot name='r'><link name='a'></robot>"),
            "robot description: not a valid URDF: Error reading end tag.");
  EXPECT_EQ(faultOf("<launch/>"),
            "robot description: not a valid URDF: Could not find the 'robot' element in the xml file");
  EXPECT_EQ(faultOf("q1,q2\n0,1\n"), "robot description: not a valid URDF: Error document empty.");
  EXPECT_EQ(faultOf("<robot name='r'/>"), "robot description: not a valid URDF: No link elements found in urdf file");
}

TEST(UrdfFaultsTest, AXacroWordInACommentIsNoXacroFile) {
  EXPECT_EQ(faultOf(simpleArm("revolute", kLimit + "<!-- <xacro:arm/> -->")), "no error");
}

TEST(UrdfFaultsTest, NumbersThatAreNone) {
  EXPECT_EQ(faultOf(simpleArm("revolute", "<limit lower='-1,5' upper='1' velocity='1' effort='1'/>")),
            "robot description: not a valid URDF: lower value (-1,5) is not a valid float; Could not parse limit "
            "element for joint [j1]");
  EXPECT_EQ(faultOf(simpleArm("revolute", "<limit lower='nan' upper='1' velocity='1' effort='1'/>")),
            "robot description: not a valid URDF: lower value (nan) is not a valid float; Could not parse limit "
            "element for joint [j1]");
}

TEST(UrdfFaultsTest, ALinkThatIsNotThereOffersTheNearestNames) {
  DescriptionOptions options;
  options.tip = "tool_tipp";
  EXPECT_EQ(sentenceOf([&] { describeRobotFile(ownUrdf("two_link"), options); }),
            ownUrdf("two_link") +
                ": no link 'tool_tipp' in robot 'two_link' of 4 links; the nearest names are 'tool_tip', 'base_link', "
                "'link_1'");
}

TEST(UrdfFaultsTest, ATipThatMustBeNamed) {
  EXPECT_EQ(faultOf("<robot name='r'><link name='base'/><link name='left'/><link name='right'/>"
                    "<joint name='a' type='fixed'><parent link='base'/><child link='left'/></joint>"
                    "<joint name='b' type='fixed'><parent link='base'/><child link='right'/></joint></robot>"),
            "robot description: robot 'r' ends in several links, so the tip must be named; choose among 'left', "
            "'right'");
}

TEST(UrdfFaultsTest, ATipThatIsNotBelowTheBase) {
  const std::string urdf = simpleArm("revolute", kLimit);
  EXPECT_EQ(faultOf(urdf, "hand", "base"),
            "robot description: tip 'base' is not below base 'hand': it is the root of robot 'r'");
  const std::string two_arms =
      simpleArm("revolute", kLimit, "",
                "<link name='other'/><joint name='j2' type='revolute'><parent link='base'/><child link='other'/>" +
                    kLimit + "</joint>");
  EXPECT_EQ(faultOf(two_arms, "other", "hand"),
            "robot description: tip 'hand' is not below base 'other'; links above the tip: 'base'");
}

TEST(UrdfFaultsTest, NoMovingJoint) {
  EXPECT_EQ(faultOf(simpleArm("fixed", "")), "robot description: no moving joint between base 'base' and tip 'hand'");
  EXPECT_EQ(faultOf(simpleArm("revolute", kLimit), "hand", "hand"),
            "robot description: no moving joint between base 'hand' and tip 'hand'");
}

TEST(UrdfFaultsTest, FloatingAndPlanarJoints) {
  EXPECT_EQ(faultOf(simpleArm("floating", "")),
            "robot description: joint 'j1' is floating; an arm and what hangs from it may have revolute, continuous, "
            "prismatic and fixed joints only");
  EXPECT_EQ(faultOf(simpleArm("planar", "")),
            "robot description: joint 'j1' is planar; an arm and what hangs from it may have revolute, continuous, "
            "prismatic and fixed joints only");
  const std::string hanging = simpleArm(
      "revolute", kLimit, "",
      "<link name='ball'/><joint name='loose' type='floating'><parent link='hand'/><child link='ball'/></joint>");
  EXPECT_EQ(faultOf(hanging, "base", "hand"),
            "robot description: joint 'loose' is floating; an arm and what hangs from it may have revolute, "
            "continuous, prismatic and fixed joints only");
}

TEST(UrdfFaultsTest, JointsOfAnotherArmAreNotJudged) {
  const std::string beside = simpleArm(
      "revolute", kLimit, "",
      "<link name='ball'/><joint name='loose' type='floating'><parent link='base'/><child link='ball'/></joint>");
  EXPECT_EQ(faultOf(beside, "base", "hand"), "no error");
}

TEST(UrdfFaultsTest, AZeroAxis) {
  EXPECT_EQ(faultOf(simpleArm("revolute", kLimit + "<axis xyz='0 0 0'/>")),
            "robot description: joint 'j1' has the axis 0 0 0, expected a direction such as 0 0 1");
}

TEST(UrdfFaultsTest, LimitsThatAreSwappedMissingNegativeOrEmpty) {
  EXPECT_EQ(faultOf(simpleArm("revolute", "<limit lower='2' upper='-1.5' velocity='1' effort='1'/>")),
            "robot description: joint 'j1' has its limits swapped: lower 2, upper -1.5 rad");
  EXPECT_EQ(faultOf(simpleArm("prismatic", "<limit lower='2' upper='-1.5' velocity='1' effort='1'/>")),
            "robot description: joint 'j1' has its limits swapped: lower 2, upper -1.5 m");
  EXPECT_EQ(faultOf(simpleArm("revolute", "")),
            "robot description: joint 'j1' is revolute and has no <limit>, expected one with lower and upper [rad], "
            "velocity and effort; if it turns without end, its type is continuous");
  EXPECT_EQ(faultOf(simpleArm("prismatic", "")),
            "robot description: joint 'j1' is prismatic and has no <limit>, expected one with lower and upper [m], "
            "velocity and effort");
  EXPECT_EQ(
      faultOf(simpleArm("revolute", "<limit lower='-1' upper='1' effort='1'/>")),
      "robot description: not a valid URDF: joint limit: no velocity; Could not parse limit element for joint [j1]");
  EXPECT_EQ(faultOf(simpleArm("revolute", "<limit lower='-1' upper='1' velocity='-1' effort='1'/>")),
            "robot description: joint 'j1' has a negative velocity or effort limit");
  EXPECT_EQ(faultOf(simpleArm(
                "revolute", kLimit + "<safety_controller k_velocity='1' soft_lower_limit='2' soft_upper_limit='3'/>")),
            "robot description: joint 'j1' has soft limits 2 to 3 that leave nothing of its hard limits -1 to 1");
}

TEST(UrdfFaultsTest, FrictionThatDrives) {
  EXPECT_EQ(faultOf(simpleArm("revolute", kLimit + "<dynamics damping='-1' friction='0'/>")),
            "robot description: joint 'j1' has negative damping or friction, which would drive it");
}

TEST(UrdfFaultsTest, NegativeMass) {
  EXPECT_EQ(faultOf(simpleArm("revolute", kLimit, "<inertial><mass value='-2'/>" + kInertia + "</inertial>")),
            "robot description: link 'hand' has mass -2 kg, expected a positive one");
}

TEST(UrdfFaultsTest, MimicsThatCannotBeFollowed) {
  const auto side = [](const std::string& mimic) {
    return "<link name='finger'/><joint name='grip' type='revolute'><parent link='hand'/><child link='finger'/>" +
           kLimit + "<mimic joint='" + mimic + "'/></joint>";
  };
  EXPECT_EQ(faultOf(simpleArm("revolute", kLimit, "", side("ghost")), "base", "hand"),
            "robot description: joint 'grip' mimics joint 'ghost', which does not exist; lock 'grip' at a "
            "position to ignore that");
  EXPECT_EQ(faultOf(simpleArm("revolute", kLimit, "", side("ghost")), "base", "finger"),
            "robot description: joint 'grip' mimics joint 'ghost', which does not exist; lock 'grip' at a "
            "position to ignore that");
  EXPECT_EQ(faultOf(simpleArm("revolute", kLimit, "", side("grip")), "base", "hand"),
            "robot description: joint 'grip' mimics itself by way of other joints");
  EXPECT_EQ(faultOf(simpleArm("revolute", kLimit, "", side("grip")), "base", "finger"),
            "robot description: joint 'grip' mimics itself by way of other joints");
  const std::string circle =
      "<link name='a'/><link name='b'/>"
      "<joint name='ja' type='revolute'><parent link='hand'/><child link='a'/>" +
      kLimit + "<mimic joint='jb'/></joint><joint name='jb' type='revolute'><parent link='hand'/><child link='b'/>" +
      kLimit + "<mimic joint='ja'/></joint>";
  EXPECT_EQ(faultOf(simpleArm("revolute", kLimit, "", circle), "base", "hand"),
            "robot description: joint 'ja' mimics itself by way of other joints");
  EXPECT_EQ(faultOf(simpleArm("revolute", kLimit, "", side("j1")), "base", "finger"),
            "robot description: joint 'grip' mimics joint 'j1', and both lie in the chain; every joint of an arm must "
            "move by itself: choose a base or tip with only one of them between, or lock 'grip' at a position");
}

TEST(UrdfFaultsTest, LinksThatAreNoTree) {
  const std::string loop =
      "<link name='x'/><link name='y'/>"
      "<joint name='a' type='fixed'><parent link='x'/><child link='y'/></joint>"
      "<joint name='b' type='fixed'><parent link='y'/><child link='x'/></joint>";
  EXPECT_EQ(faultOf(simpleArm("revolute", kLimit, "", loop), "base", "hand"),
            "robot description: links 'x', 'y' form a loop that does not hang from the root link 'base'; a URDF must "
            "be a tree");
  const std::string second_parent =
      "<link name='x'/><joint name='a' type='fixed'><parent link='base'/><child link='x'/></joint>"
      "<joint name='b' type='fixed'><parent link='x'/><child link='hand'/></joint>";
  EXPECT_EQ(faultOf(simpleArm("revolute", kLimit, "", second_parent), "base", "hand"),
            "robot description: link 'hand' is the child of two joints; a URDF must be a tree");
  EXPECT_EQ(faultOf(simpleArm("revolute", kLimit, "", "<link name='alone'/>")),
            "robot description: not a valid URDF: Failed to find root link: Two root links found: [alone] and [base]");
}

TEST(UrdfFaultsTest, InertiaIsAskedForOnlyByDynamics) {
  const RobotModel massless(describeRobot(simpleArm("revolute", kLimit), {}));
  const Eigen::VectorXd q = Eigen::VectorXd::Constant(1, 0.3);
  EXPECT_NO_THROW(massless.forwardKinematics(q));
  EXPECT_EQ(sentenceOf([&] { massless.gravity(q); }),
            "no dynamics for robot 'r': robot description: nothing that joint 'j1' moves has mass up to the next "
            "joint; give link 'hand' an <inertial> element");

  const std::string impossible =
      "<inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='3'/></inertial>";
  const RobotModel unphysical(describeRobot(simpleArm("revolute", kLimit, impossible), {}));
  EXPECT_NO_THROW(unphysical.jacobian(q));
  EXPECT_EQ(sentenceOf([&] { unphysical.massMatrix(q); }),
            "no dynamics for robot 'r': robot description: link 'hand' has principal moments of inertia 1, 1, 3 "
            "kg m², which no body has: the largest may not exceed the sum of the other two");
}

TEST(UrdfFaultsTest, DoubtfulInertiaIsAWarningWhereItCanBeComputedWith) {
  const auto inertial = [](const std::string& izz) {
    return "<inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='" + izz + "'/></inertial>";
  };
  const RobotDescription slightly = describeRobot(simpleArm("revolute", kLimit, inertial("2.1")), {});
  EXPECT_EQ(slightly.inertia_fault, "");
  EXPECT_EQ(slightly.warnings,
            std::vector<std::string>{"robot description: link 'hand' has principal moments of inertia 1, 1, 2.1 kg m², "
                                     "which no body has: the largest may not exceed the sum of the other two"});
  EXPECT_TRUE(describeRobot(simpleArm("revolute", kLimit, inertial("2")), {}).warnings.empty()) << "a plate";

  const std::string tool = "<link name='tool'>" + inertial("9") +
                           "</link><joint name='mount' type='fixed'><parent link='hand'/><child link='tool'/>";
  const RobotDescription lumped = describeRobot(
      simpleArm("revolute", kLimit,
                "<inertial><mass value='1'/><inertia ixx='20' ixy='0' ixz='0' iyy='20' iyz='0' izz='20'/></inertial>",
                tool + "</joint>"),
      {});
  EXPECT_EQ(lumped.inertia_fault, "") << "hand and tool move as one, and as one they are possible";
  EXPECT_EQ(lumped.warnings.size(), 1u);
}

TEST(UrdfFaultsTest, InertiaThatCannotBeReadIsNoMasslessLink) {
  const auto dynamicsFaultOf = [](const std::string& in_inertial) {
    const std::string urdf = simpleArm("revolute", kLimit, "<inertial>" + in_inertial + "</inertial>");
    return sentenceOf([&] { RobotModel(describeRobot(urdf, {})).gravity(Eigen::VectorXd::Zero(1)); });
  };
  const std::string where =
      "no dynamics for robot 'r': robot description: link 'hand' has an <inertial> element that "
      "cannot be read: ";
  EXPECT_EQ(dynamicsFaultOf("<mass value='nan'/>" + kInertia), where + "Inertial: mass [nan] is not a float");
  EXPECT_EQ(dynamicsFaultOf("<mass value='1'/>"), where + "Inertial element must have inertia element");
  EXPECT_EQ(dynamicsFaultOf(kInertia), where + "Inertial element must have a mass element");
  EXPECT_EQ(dynamicsFaultOf("<mass value='1'/>" + kInertia), "no error");
}

TEST(UrdfFaultsTest, AMassThatFollowsTheArmCannotBeLumped) {
  const auto grip = [](const std::string& in_finger) {
    return simpleArm("revolute", kLimit, "<inertial><mass value='1'/>" + kInertia + "</inertial>",
                     "<link name='finger'>" + in_finger +
                         "</link><joint name='grip' type='revolute'><parent link='hand'/><child link='finger'/>" +
                         kLimit + "<mimic joint='j1'/></joint>");
  };
  const std::string heavy = "<inertial><mass value='0.1'/>" + kInertia + "</inertial>";
  DescriptionOptions to_hand;
  to_hand.tip = "hand";
  EXPECT_EQ(describeRobot(grip(heavy), to_hand).inertia_fault,
            "robot description: link 'finger' hangs from joint 'grip', which mimics joint 'j1' of the arm; lock 'grip' "
            "at a position to ignore that");
  EXPECT_EQ(describeRobot(grip(""), to_hand).inertia_fault, "") << "what weighs nothing may move as it likes";
  to_hand.locked = {{"grip", 0.2}};
  EXPECT_DOUBLE_EQ(describeRobot(grip(heavy), to_hand).joints[0].body.mass, 1.1);
}

TEST(UrdfFaultsTest, ABaseThatFollowsTheArmHasNoConstantGravity) {
  const std::string urdf =
      "<robot name='r'><link name='world'/><link name='base'/><link name='hand'><inertial><mass value='1'/>" +
      kInertia + "</inertial></link><joint name='lean' type='revolute'><parent link='world'/><child link='base'/>" +
      kLimit + "<mimic joint='j1'/></joint><joint name='j1' type='revolute'><parent link='base'/><child link='hand'/>" +
      kLimit + "</joint></robot>";
  DescriptionOptions options;
  options.base = "base";
  EXPECT_EQ(
      describeRobot(urdf, options).inertia_fault,
      "robot description: base 'base' hangs from joint 'lean', which mimics joint 'j1' of the arm; lock 'lean' at "
      "a position to ignore that");
}

TEST(UrdfFaultsTest, OriginsThatAreNone) {
  const auto originFault = [](const std::string& xyz) {
    return faultOf(simpleArm("revolute", kLimit + "<origin xyz='" + xyz + "'/>"));
  };
  const auto sentence = [](const std::string& component) {
    return "robot description: not a valid URDF: Unable to parse component [" + component +
           "] to a double (while parsing a vector value); Malformed parent origin element for joint [j1]";
  };
  EXPECT_EQ(originFault("0,5 0 0"), sentence("0,5"));
  EXPECT_EQ(originFault("nan 0 0"), sentence("nan"));
  EXPECT_EQ(originFault("0 inf 0"), sentence("inf"));
  EXPECT_EQ(originFault("0 0 1e999"), sentence("1e999"));
  EXPECT_EQ(originFault("0 0"),
            "robot description: not a valid URDF: Parser found 2 elements but 3 expected while parsing vector [0 0]; "
            "Malformed parent origin element for joint [j1]");
  EXPECT_EQ(faultOf(simpleArm("revolute", kLimit + "<axis xyz='0 0 nan'/>")),
            "robot description: not a valid URDF: Malformed axis element for joint [j1]: Unable to parse component "
            "[nan] to a double (while parsing a vector value)");
}

TEST(UrdfFaultsTest, APlaceTooFarAway) {
  const std::string far = "<origin xyz='1e308 1e308 0' rpy='0 0 0.7'/>";
  const std::string urdf =
      "<robot name='r'><link name='base'/><link name='a'/><link name='hand'/><joint name='f' type='fixed'><parent "
      "link='base'/><child link='a'/>" +
      far + "</joint><joint name='j1' type='revolute'><parent link='a'/><child link='hand'/>" + kLimit + far +
      "</joint></robot>";
  EXPECT_EQ(faultOf(urdf), "robot description: joint 'j1' lies too far away to be placed; look at its origin");
}

TEST(UrdfFaultsTest, NamesThatAppearTwice) {
  EXPECT_EQ(faultOf(simpleArm("revolute", kLimit, "", "<link name='hand'/>")),
            "robot description: not a valid URDF: link 'hand' is not unique.");
  EXPECT_EQ(faultOf(simpleArm("revolute", kLimit, "",
                              "<link name='x'/><joint name='j1' type='fixed'><parent link='hand'/><child "
                              "link='x'/></joint>")),
            "robot description: not a valid URDF: joint 'j1' is not unique.");
}

TEST(UrdfFaultsTest, WhatAMacroLeftBehind) {
  const std::string advice = ">; expand the xacro file that it comes from: xacro FILE > robot.urdf";
  EXPECT_EQ(faultOf(simpleArm("revolute", kLimit + "<origin xyz='${length} 0 0'/>")),
            "robot description: the URDF still holds a macro, <origin xyz='${length} 0 0'" + advice);
  EXPECT_EQ(faultOf(simpleArm("revolute", kLimit, "", "<link name=\"$(arg prefix)tool\"/>")),
            "robot description: the URDF still holds a macro, <link name=\"$(arg prefix)tool\"" + advice);
  EXPECT_EQ(faultOf(simpleArm("revolute", kLimit,
                              "<visual><geometry><mesh filename='file://$(find arm)/hand.stl'/></geometry></visual>",
                              "<gazebo><plugin name='p'><topic>${ns}</topic></plugin></gazebo><!-- ${old} <xacro:x/> "
                              "-->")),
            "no error")
      << "what neither moves nor weighs may hold anything";
}

TEST(UrdfFaultsTest, AxesOfAnyLengthAreDirections) {
  for (const std::string length : {"1e-200", "3", "1e200"}) {
    const RobotDescription arm = describeRobot(simpleArm("revolute", kLimit + "<axis xyz='0 -" + length + " 0'/>"), {});
    EXPECT_TRUE(arm.joints[0].axis.isApprox(-Eigen::Vector3d::UnitY())) << length;
  }
}

TEST(UrdfFaultsTest, NothingIsPrintedToTheConsole) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  faultOf(simpleArm("revolute", ""));
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace demo_logger
