#pragma once

#include <cstdlib>
#include <string>
#include <vector>

#include "demo_logger/robot/robot_description.h"

namespace demo_logger {

struct RealArm {
  std::string file, base, tip;
};

/// Arms that people own, looked for in the folder that DEMO_LOGGER_URDF names; empty if it names none.
inline std::string realArmFolder() {
  const char* folder = std::getenv("DEMO_LOGGER_URDF");
  return folder == nullptr ? "" : folder;
}

inline std::vector<RealArm> realArms() {
  return {{"panda", "panda_link0", "panda_hand_tcp"},
          {"iiwa14", "iiwa_link_0", "iiwa_link_ee"},
          {"gen3_7dof_2f85", "base_link", "tool_frame"},
          {"baxter", "base", "right_gripper"},
          {"baxter", "base", "left_gripper"},
          {"pr2", "torso_lift_link", "r_wrist_roll_link"},
          {"yumi", "yumi_base_link", "gripper_r_base"},
          {"yumi", "yumi_base_link", "gripper_l_base"},
          {"sia20d", "base_link", "tool0"},
          {"ur5", "base_link", "tool0"},
          {"gen3_lite", "base_link", "tool_frame"},
          {"vx300s", "vx300s/base_link", "vx300s/ee_gripper_link"}};
}

inline std::string realArmPath(const RealArm& arm) { return realArmFolder() + "/" + arm.file + ".urdf"; }

inline RobotDescription describeRealArm(const RealArm& arm) {
  DescriptionOptions options;
  options.base = arm.base;
  options.tip = arm.tip;
  return describeRobotFile(realArmPath(arm), options);
}

}  // namespace demo_logger
