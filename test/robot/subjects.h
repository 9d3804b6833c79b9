#pragma once

#include <Eigen/Core>
#include <random>
#include <string>
#include <vector>

#include "demo_logger/robot/robot_description.h"
#include "test/robot/own_arms.h"
#include "test/robot/real_arms.h"

namespace demo_logger {

struct Subject {
  std::string name;
  RobotDescription arm;
};

/// The package's arm, and those of the folder if it is there.
inline std::vector<Subject> solverSubjects() {
  std::vector<Subject> subjects{{"demo_arm", describeOwnArm("demo_arm")}};
  if (realArmFolder().empty()) return subjects;
  for (const RealArm& arm : realArms()) subjects.push_back({arm.file + " " + arm.tip, describeRealArm(arm)});
  return subjects;
}

/// Uniform within limits; within one turn where there are none.
inline Eigen::VectorXd randomPosture(const RobotDescription& arm, std::mt19937_64& generator) {
  Eigen::VectorXd q(static_cast<Eigen::Index>(arm.joints.size()));
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const ArmJoint& joint = arm.joints[static_cast<std::size_t>(i)];
    const bool limited = std::isfinite(joint.lower);
    q[i] =
        std::uniform_real_distribution<double>(limited ? joint.lower : -M_PI, limited ? joint.upper : M_PI)(generator);
  }
  return q;
}

}  // namespace demo_logger
