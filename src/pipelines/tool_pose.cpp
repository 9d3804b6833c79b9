#include "demo_logger/pipelines/tool_pose.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/not_a_number.h"
#include "joint_columns.h"

namespace demo_logger {
namespace {

std::vector<Column> poseColumns(const RobotDescription& robot) {
  const std::string source = "forward kinematics of " + robot.tip + " in " + robot.base;
  std::vector<Column> columns;
  for (const char* axis : {"x", "y", "z"}) {
    columns.push_back({std::string("ee_") + axis, "m", Role::state, Interpolation::linear, source});
  }
  for (const char* component : {"qx", "qy", "qz", "qw"}) {
    columns.push_back({std::string("ee_") + component, "", Role::state, Interpolation::slerp, source});
  }
  return columns;
}

/// Where each joint's position stands in a row; empty if one is missing.
std::vector<std::size_t> findPositions(const std::vector<Column>& columns, const std::vector<std::string>& joints) {
  std::vector<std::size_t> positions;
  for (const std::string& joint : joints) {
    const auto found = findJointColumn(columns, kPosition, joint);
    if (!found) {
      return {};
    }
    positions.push_back(*found);
  }
  return positions;
}

}  // namespace

class ToolPose::Implementation {
 public:
  explicit Implementation(const RobotDescription& robot) : model_(robot), q_(model_.size()) {}

  std::vector<Column> open(const std::vector<Column>& recorded) {
    previous_ = Eigen::Quaterniond(1.0, 0.0, 0.0, 0.0);
    positions_ = findPositions(recorded, model_.description().jointNames());
    return positions_.empty() ? std::vector<Column>{} : poseColumns(model_.description());
  }

  void append(Row& row) {
    if (positions_.empty()) {
      return;
    }
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      q_[static_cast<Eigen::Index>(i)] = row.values[positions_[i]];
    }
    if (!q_.allFinite()) {
      row.values.insert(row.values.end(), 7, kNaN);
      return;
    }
    const Eigen::Isometry3d X_base_tip = model_.forwardKinematics(q_);
    const Eigen::Vector3d p = X_base_tip.translation();
    Eigen::Quaterniond orientation(X_base_tip.linear());
    if (orientation.dot(previous_) < 0.0) {
      orientation.coeffs() = -orientation.coeffs();
    }
    previous_ = orientation;
    row.values.insert(row.values.end(),
                      {p.x(), p.y(), p.z(), orientation.x(), orientation.y(), orientation.z(), orientation.w()});
  }

 private:
  RobotModel model_;
  Eigen::VectorXd q_;
  std::vector<std::size_t> positions_;
  Eigen::Quaterniond previous_;  // the identity first: on its side is qw ≥ 0
};

ToolPose::ToolPose(const RobotDescription& robot) : implementation_(std::make_unique<Implementation>(robot)) {}
ToolPose::~ToolPose() = default;

std::vector<Column> ToolPose::open(const std::vector<Column>& recorded) { return implementation_->open(recorded); }
void ToolPose::append(Row& row) { implementation_->append(row); }

std::size_t addToolPose(const RobotDescription& robot, Demonstration& demonstration) {
  for (const std::string& joint : robot.jointNames()) {
    if (!findJointColumn(demonstration.columns, kPosition, joint)) {
      throw ConfigurationError("no column `" + jointColumnName(kPosition, joint) + "` with the position of joint '" +
                               joint + "', which the pose of '" + robot.tip + "' in '" + robot.base + "' depends on");
    }
  }
  const std::vector<Column> added = poseColumns(robot);
  const Eigen::Index before = replaceColumns(added, demonstration);
  ToolPose tool(robot);
  tool.open(demonstration.columns);
  std::size_t without_pose = 0;
  Row row;
  for (Eigen::Index i = 0; i < demonstration.values.rows(); ++i) {
    auto values = demonstration.values.row(i);
    row.values.assign(values.data(), values.data() + before);
    tool.append(row);
    std::copy(row.values.begin() + before, row.values.end(), values.data() + before);
    if (std::isnan(row.values.back())) ++without_pose;
  }
  return without_pose;
}

}  // namespace demo_logger
