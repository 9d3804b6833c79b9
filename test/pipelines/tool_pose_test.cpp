#include "demo_logger/pipelines/tool_pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace demo_logger {
namespace {

constexpr double kLinkOne = 0.5;  // [m], urdf/two_link.urdf
constexpr double kLinkTwo = 0.4;
constexpr double kTolerance = 1e-12;

RobotDescription twoLinkArm() {
  return describeRobotFile(DEMO_LOGGER_SOURCE_DIR "/urdf/two_link.urdf", {"base_link", "tool_tip", {}, 9.81});
}

Column position(const std::string& joint) {
  return {"q_" + joint, "rad", Role::state, Interpolation::linear, "joint_states/position/" + joint};
}

/// The pose that `append` adds to a row of positions.
std::vector<double> poseAt(ToolPose& tool, double q1, double q2) {
  Row row;
  row.values = {q1, q2};
  tool.append(row);
  return {row.values.begin() + 2, row.values.end()};
}

TEST(ToolPoseTest, FollowsTheClosedFormOfThePlanarArm) {
  ToolPose tool(twoLinkArm());
  tool.open({position("joint_1"), position("joint_2")});
  const double q1 = 0.3;
  const double q2 = -1.1;
  const std::vector<double> pose = poseAt(tool, q1, q2);
  const double half = (q1 + q2) / 2;  // both joints turn about y
  const std::vector<double> expected = {kLinkOne * std::sin(q1) + kLinkTwo * std::sin(q1 + q2),
                                        0.0,
                                        kLinkOne * std::cos(q1) + kLinkTwo * std::cos(q1 + q2),
                                        0.0,
                                        std::sin(half),
                                        0.0,
                                        std::cos(half)};
  ASSERT_EQ(pose.size(), expected.size());
  for (std::size_t i = 0; i < pose.size(); ++i) EXPECT_NEAR(pose[i], expected[i], kTolerance) << i;
}

TEST(ToolPoseTest, NamesItsColumnsWithUnitsAndSaysHowToResampleThem) {
  ToolPose tool(twoLinkArm());
  const std::vector<Column> columns = tool.open({position("joint_1"), position("joint_2")});
  const std::vector<std::string> names = {"ee_x", "ee_y", "ee_z", "ee_qx", "ee_qy", "ee_qz", "ee_qw"};
  ASSERT_EQ(columns.size(), names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(columns[i].name, names[i]);
    EXPECT_EQ(columns[i].unit, i < 3 ? "m" : "");
    EXPECT_EQ(columns[i].role, Role::state);
    EXPECT_EQ(columns[i].interpolation, i < 3 ? Interpolation::linear : Interpolation::slerp);
    EXPECT_EQ(columns[i].source, "forward kinematics of tool_tip in base_link");
  }
}

TEST(ToolPoseTest, FindsTheJointsByNameWhateverTheirOrder) {
  ToolPose tool(twoLinkArm());
  tool.open({position("joint_2"), position("joint_1")});
  const std::vector<double> pose = poseAt(tool, /*joint_2=*/-1.1, /*joint_1=*/0.3);
  EXPECT_NEAR(pose[0], kLinkOne * std::sin(0.3) + kLinkTwo * std::sin(0.3 - 1.1), kTolerance);
}

TEST(ToolPoseTest, TheQuaternionNeverChangesItsSignBetweenRowsThroughTwoTurns) {
  ToolPose tool(twoLinkArm());
  tool.open({position("joint_1"), position("joint_2")});
  constexpr double kStep = 0.05;
  for (double angle = 0.0; angle < 4 * M_PI; angle += kStep) {
    const std::vector<double> pose = poseAt(tool, angle, 0.0);
    EXPECT_NEAR(pose[4], std::sin(angle / 2), kTolerance) << "at " << angle << " rad";
    EXPECT_NEAR(pose[6], std::cos(angle / 2), kTolerance) << "at " << angle << " rad";
  }
}

TEST(ToolPoseTest, EveryEpisodeBeginsWithAPositiveScalarPart) {
  ToolPose tool(twoLinkArm());
  const std::vector<Column> recorded = {position("joint_1"), position("joint_2")};
  tool.open(recorded);
  for (double angle = 0.0; angle < 6.0; angle += 0.1) poseAt(tool, angle, 0.0);
  EXPECT_LT(poseAt(tool, 6.0, 0.0)[6], 0.0) << "continued from before";
  tool.open(recorded);
  EXPECT_GT(poseAt(tool, 6.0, 0.0)[6], 0.0) << "the same pose, first of an episode";
}

TEST(ToolPoseTest, AMissingPositionGivesAMissingPoseAndTheNextRowIsRightAgain) {
  ToolPose tool(twoLinkArm());
  tool.open({position("joint_1"), position("joint_2")});
  const std::vector<double> missing = poseAt(tool, std::numeric_limits<double>::quiet_NaN(), 0.0);
  ASSERT_EQ(missing.size(), 7U);
  for (const double value : missing) EXPECT_TRUE(std::isnan(value));
  EXPECT_NEAR(poseAt(tool, 0.0, 0.0)[2], kLinkOne + kLinkTwo, kTolerance);
}

TEST(ToolPoseTest, AChainThatIsNotRecordedWhollyGetsNoColumns) {
  ToolPose tool(twoLinkArm());
  EXPECT_TRUE(tool.open({position("joint_1")}).empty());
  Row row;
  row.values = {0.5};
  tool.append(row);
  EXPECT_EQ(row.values.size(), 1U);
}

}  // namespace
}  // namespace demo_logger
