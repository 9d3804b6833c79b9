#include "joint_columns.h"

#include <algorithm>
#include <limits>

#include "demo_logger/formats/column_names.h"

namespace demo_logger {
namespace {

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

std::string jointColumnName(const JointQuantity& quantity, const std::string& joint) {
  return makePortable({quantity.prefix + joint}).names.front();
}

std::optional<std::size_t> findJointColumn(const std::vector<Column>& columns, const JointQuantity& quantity,
                                           const std::string& joint) {
  const std::string name = jointColumnName(quantity, joint);
  const std::string source = std::string(quantity.word) + "/" + joint;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Column& column = columns[i];
    const bool found = column.source.empty()
                           ? column.name == name
                           : column.source == "joint_states/" + source || column.source == kSmoothed + source;
    if (found) return i;
  }
  return std::nullopt;
}

Eigen::Index replaceColumns(const std::vector<Column>& added, Demonstration& demonstration) {
  removeColumns(added, demonstration);
  const Eigen::Index before = demonstration.values.cols();
  demonstration.values.conservativeResize(Eigen::NoChange, before + static_cast<Eigen::Index>(added.size()));
  demonstration.values.rightCols(static_cast<Eigen::Index>(added.size()))
      .setConstant(std::numeric_limits<double>::quiet_NaN());
  demonstration.columns.insert(demonstration.columns.end(), added.begin(), added.end());
  return before;
}

}  // namespace demo_logger
