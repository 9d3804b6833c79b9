#include "joint_notes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "demo_logger/trajectory/print.h"
#include "joint_columns.h"

namespace demo_logger {

using Index = Eigen::Index;

void noteMovingJointsBesideTheChain(const RobotDescription& robot, const Demonstration& demonstration,
                                    std::vector<std::string>& notes) {
  constexpr double kMoves = 0.01;  // [rad or m] beyond what an encoder's noise does
  const std::string prefix = kPosition.prefix;
  const std::string source = std::string("joint_states/") + kPosition.word + "/";
  for (std::size_t c = 0; c < demonstration.columns.size(); ++c) {
    const Column& column = demonstration.columns[c];
    std::string joint;
    if (column.source.rfind(source, 0) == 0) joint = column.source.substr(source.size());
    if (column.source.empty() && column.name.rfind(prefix, 0) == 0) joint = column.name.substr(prefix.size());
    const auto& names = robot.jointNames();
    const bool is_of_chain = std::any_of(names.begin(), names.end(), [&](const std::string& name) {
      return name == joint || jointColumnName(kPosition, name) == column.name;
    });
    if (joint.empty() || is_of_chain) continue;
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (const double position : demonstration.values.col(static_cast<Index>(c))) {
      if (std::isnan(position)) continue;
      least = std::min(least, position);
      most = std::max(most, position);
    }
    if (!(most - least > kMoves)) continue;
    notes.push_back("joint '" + joint + "' moves by " + print(most - least, 3) + " rad or m, but is not between " +
                    robot.base + " and " + robot.tip + ": the model holds it still (--at says where)");
  }
}

void noteMissingPositions(const RobotDescription& robot, const Eigen::MatrixXd& position,
                          std::vector<std::string>& notes) {
  for (Index k = 0; k < position.rows(); ++k) {
    if (position.row(k).allFinite()) return;
  }
  Index worst = 0;
  const Index missing = position.array().isNaN().cast<Index>().colwise().sum().maxCoeff(&worst);
  notes.push_back("in no row do all joints have a position (joint '" +
                  robot.joints[static_cast<std::size_t>(worst)].name + "' has none in " + std::to_string(missing) +
                  " of " + std::to_string(position.rows()) + "): nothing can be told");
}

void notePositionsBeyondLimits(const RobotDescription& robot, const std::vector<double>& time,
                               const Eigen::MatrixXd& position, std::vector<std::string>& notes) {
  constexpr double kTolerated = 0.1;  // of the range: limits of software are passed by a little
  for (Index i = 0; i < position.cols(); ++i) {
    const ArmJoint& joint = robot.joints[static_cast<std::size_t>(i)];
    const double beyond = kTolerated * (joint.upper - joint.lower);
    if (!std::isfinite(beyond)) continue;
    std::size_t rows = 0;
    Index first = 0;
    for (Index k = 0; k < position.rows(); ++k) {
      if (!(position(k, i) < joint.lower - beyond) && !(position(k, i) > joint.upper + beyond)) continue;
      if (rows++ == 0) first = k;
    }
    if (rows == 0) continue;
    const char* unit = joint.type == JointType::prismatic ? " m" : " rad";
    notes.push_back("joint '" + joint.name + "' is at " + print(position(first, i)) + unit + " at " +
                    printExactly(time[static_cast<std::size_t>(first)]) + " s" +
                    (rows == 1 ? "" : ", the first of " + std::to_string(rows) + " such rows") +
                    ", far beyond its limits of " + print(joint.lower) + " to " + print(joint.upper) + unit +
                    ": what is said around there is worth as much; `demo_tool check` may say more");
  }
}

}  // namespace demo_logger
