#include "demo_logger/pipelines/tool_pose.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>

#include "demo_logger/formats/column_names.h"
#include "demo_logger/robot/robot_model.h"
#include "demo_logger/trajectory/error.h"

namespace demo_logger {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

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

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// The column of a joint's position, by its source, or without one by its name.
std::optional<std::size_t> findPosition(const std::vector<Column>& columns, const std::string& joint) {
  const std::string name = makePortable({"q_" + joint}).names.front();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Column& column = columns[i];
    if (column.role != Role::state) continue;
    if (column.source.empty() ? column.name == name : endsWith(column.source, "/position/" + joint)) return i;
  }
  return std::nullopt;
}

/// Where each joint's position stands in a row; empty if one is missing.
std::vector<std::size_t> findPositions(const std::vector<Column>& columns, const std::vector<std::string>& joints) {
  std::vector<std::size_t> positions;
  for (const std::string& joint : joints) {
    const auto found = findPosition(columns, joint);
    if (!found) {
      return {};
    }
    positions.push_back(*found);
  }
  return positions;
}

void removeColumns(const std::vector<Column>& names, Demonstration& demonstration) {
  for (const Column& gone : names) {
    std::vector<Column>& columns = demonstration.columns;
    const auto found =
        std::find_if(columns.begin(), columns.end(), [&](const Column& column) { return column.name == gone.name; });
    if (found == columns.end()) continue;
    const Eigen::Index at = found - columns.begin();
    const Eigen::Index behind = demonstration.values.cols() - at - 1;
    demonstration.values.middleCols(at, behind) = demonstration.values.rightCols(behind).eval();
    demonstration.values.conservativeResize(Eigen::NoChange, demonstration.values.cols() - 1);
    columns.erase(found);
  }
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

void addToolPose(const RobotDescription& robot, Demonstration& demonstration) {
  for (const std::string& joint : robot.jointNames()) {
    if (!findPosition(demonstration.columns, joint)) {
      throw ConfigurationError("no column `" + makePortable({"q_" + joint}).names.front() +
                               "` with the position of joint '" + joint + "', which the pose of '" + robot.tip +
                               "' in '" + robot.base + "' depends on");
    }
  }
  removeColumns(poseColumns(robot), demonstration);
  ToolPose tool(robot);
  const std::vector<Column> added = tool.open(demonstration.columns);
  const Eigen::Index before = demonstration.values.cols();
  demonstration.values.conservativeResize(Eigen::NoChange, before + static_cast<Eigen::Index>(added.size()));
  demonstration.columns.insert(demonstration.columns.end(), added.begin(), added.end());
  Row row;
  for (Eigen::Index i = 0; i < demonstration.values.rows(); ++i) {
    auto values = demonstration.values.row(i);
    row.values.assign(values.data(), values.data() + before);
    tool.append(row);
    std::copy(row.values.begin() + before, row.values.end(), values.data() + before);
  }
}

}  // namespace demo_logger
