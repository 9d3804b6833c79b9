#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "demo_logger/trajectory/demonstration.h"

namespace demo_logger {

/// What is recorded of a joint: `prefix` of the column ("q_"), word in its source ("position"), and units.
struct JointQuantity {
  const char* prefix;
  const char* word;
  const char* turning = "";  // unit, of a joint that turns
  const char* sliding = "";  // ditto, that slides
};

constexpr JointQuantity kPosition = {"q_", "position", "rad", "m"};
constexpr JointQuantity kEffort = {"tau_", "effort", "N m", "N"};

/// [N m or N] beyond what any motor gives: an effort that says so is none.
constexpr double kMostTorque = 1e6;

/// How the source of a column begins that was made from positions by a smoother.
constexpr const char* kSmoothed = "smoothed/";

/// The column of a joint, by its source joint_states/<word>/<joint> (or smoothed/…), or without a source by its name.
std::optional<std::size_t> findJointColumn(const std::vector<Column>& columns, const JointQuantity& quantity,
                                           const std::string& joint);

/// The portable name of such a column.
std::string jointColumnName(const JointQuantity& quantity, const std::string& joint);

/// Adds columns at the end, in place of those of the same names, filled with NaN. Returns where the first of them is.
Eigen::Index replaceColumns(const std::vector<Column>& added, Demonstration& demonstration);

}  // namespace demo_logger
