#include "demo_logger/robot/attached_links.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "demo_logger/robot/robot_model.h"
#include "test/robot/own_arms.h"

namespace demo_logger {
namespace {

std::string textOf(const std::string& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

DescriptionOptions demoOptions() {
  DescriptionOptions options;
  options.base = "base_link";
  options.tip = "tool_tip";
  return options;
}

const AttachedLink& find(const std::vector<AttachedLink>& links, const std::string& name) {
  return *std::find_if(links.begin(), links.end(), [&](const AttachedLink& link) { return link.name == name; });
}

TEST(AttachedLinksTest, TheTipHangsFromTheLastJointWhereTheDescriptionSays) {
  const std::vector<AttachedLink> links = attachedLinks(textOf(ownUrdf("demo_arm")), demoOptions());
  const AttachedLink& tip = find(links, "tool_tip");
  EXPECT_EQ(tip.joint, 6);
  EXPECT_TRUE(tip.X_body_link.isApprox(describeOwnArm("demo_arm").X_lastlink_tip, 1e-12));
  EXPECT_EQ(find(links, "base_link").joint, -1);
  EXPECT_TRUE(find(links, "link_3").X_body_link.isApprox(Eigen::Isometry3d::Identity(), 1e-12));
  EXPECT_EQ(find(links, "link_3").joint, 2);
}

TEST(AttachedLinksTest, ALinkBesideTheChainIsWhereItsOwnChainPutsIt) {
  const std::string urdf = textOf(ownUrdf("demo_arm"));
  const std::vector<AttachedLink> links = attachedLinks(urdf, demoOptions());
  DescriptionOptions beside = demoOptions();
  beside.tip = "sensor_box";
  const RobotDescription other = describeRobot(urdf, beside);
  const AttachedLink& box = find(links, "sensor_box");
  EXPECT_EQ(box.joint, static_cast<int>(other.joints.size()) - 1);
  EXPECT_TRUE(box.X_body_link.isApprox(other.X_lastlink_tip, 1e-12));
}

TEST(AttachedLinksTest, ShapesAreReadInTheirLinksFrame) {
  const std::string urdf = R"(<robot name="r">
    <link name="base"/>
    <link name="arm">
      <collision><origin xyz="1 2 3"/><geometry><box size="0.1 0.2 0.3"/></geometry></collision>
      <collision><geometry><sphere radius="0.4"/></geometry></collision>
      <collision><geometry><cylinder radius="0.5" length="0.6"/></geometry></collision>
      <collision><geometry><mesh filename="package://nowhere/arm.stl"/></geometry></collision>
    </link>
    <joint name="j" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/></joint>
  </robot>)";
  const std::vector<AttachedLink> links = attachedLinks(urdf, {});
  const AttachedLink& arm = find(links, "arm");
  ASSERT_EQ(arm.shapes.size(), 3U);
  EXPECT_EQ(arm.shapes[0].kind, CollisionShape::Kind::box);
  EXPECT_EQ(arm.shapes[0].size, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(arm.shapes[0].pose.translation(), Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(arm.shapes[1].size, Eigen::Vector3d(0.4, 0.0, 0.0));
  EXPECT_EQ(arm.shapes[2].size, Eigen::Vector3d(0.5, 0.6, 0.0));
  EXPECT_TRUE(arm.has_mesh);
}

TEST(AttachedLinksTest, WhatTheBaseHangsFromIsPlacedInTheBase) {
  const std::string urdf = R"(<robot name="r">
    <link name="world"/><link name="base"/><link name="arm"/>
    <joint name="mount" type="fixed"><origin xyz="0 0 0.7"/><parent link="world"/><child link="base"/></joint>
    <joint name="j" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/></joint>
  </robot>)";
  DescriptionOptions options;
  options.base = "base";
  const std::vector<AttachedLink> links = attachedLinks(urdf, options);
  EXPECT_EQ(find(links, "world").X_body_link.translation(), Eigen::Vector3d(0.0, 0.0, -0.7));
  EXPECT_EQ(find(links, "world").joint, -1);
}

}  // namespace
}  // namespace demo_logger
