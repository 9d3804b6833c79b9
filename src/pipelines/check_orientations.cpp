#include <cmath>

#include "check_parts.h"

namespace demo_logger {
namespace {

// The first of four columns …_qx …_qy …_qz …_qw in a row, whatever their interpolation.
std::vector<Eigen::Index> findOrientations(const std::vector<Column>& columns) {
  std::vector<Eigen::Index> orientations;
  for (std::size_t i = 0; i + 4 <= columns.size(); ++i) {
    const std::string& name = columns[i].name;
    if (name.size() < 3 || name.compare(name.size() - 3, 3, "_qx") != 0) {
      continue;
    }
    const std::string stem = name.substr(0, name.size() - 1);
    if (columns[i + 1].name == stem + "y" && columns[i + 2].name == stem + "z" && columns[i + 3].name == stem + "w") {
      orientations.push_back(static_cast<Eigen::Index>(i));
    }
  }
  return orientations;
}

}  // namespace

void checkOrientations(const Demonstration& demonstration, const CheckLimits& limits, Findings& findings) {
  for (const Eigen::Index first : findOrientations(demonstration.columns)) {
    std::size_t count = 0;
    double when = 0.0;
    double length = 1.0;
    for (std::size_t row = 0; row < demonstration.time.size(); ++row) {
      const double norm = demonstration.values.row(static_cast<Eigen::Index>(row)).segment<4>(first).norm();
      if (std::abs(norm - 1.0) > limits.quaternion_length && count++ == 0) {
        when = demonstration.time[row];
        length = norm;
      }
    }
    if (count > 0) {
      findings.add("quaternion", Severity::error,
                   "orientation " + demonstration.columns[static_cast<std::size_t>(first)].name +
                       " … qw is no unit quaternion in " + formatCount(count, "row") + ", first " +
                       formatInstant(when) + " with length " + formatNumber(length) +
                       ", expected 1; did its publisher leave it zero, or average quaternions?");
    }
  }
}

}  // namespace demo_logger
