#pragma once

#include <string>
#include <vector>

#include "demo_logger/recording/synchroniser.h"
#include "demo_logger/trajectory/column.h"
#include "demo_logger/trajectory/metadata.h"

namespace demo_logger {

/// Columns computed from a row while it is recorded (tool pose, human torque), appended after the recorded ones.
class DerivedColumns {
 public:
  virtual ~DerivedColumns() = default;
  /// Called when an episode opens (and so forgets the last one): what it will append to each row of `recorded` columns.
  virtual std::vector<Column> open(const std::vector<Column>& recorded) = 0;
  /// Appends its values to row.values, NaN where they cannot be computed. Never throws.
  virtual void append(Row& row) = 0;
  /// Why values are missing, since the episode opened: for its sidecar and the status.
  virtual std::vector<Fault> faults() const { return {}; }
};

}  // namespace demo_logger
