#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "demo_logger/recording/stream_configuration.h"
#include "demo_logger/trajectory/column.h"

namespace demo_logger {

/// The columns of the joint states: q_…, dq_…, tau_… of all joints, receipt_delay, and the ages of the merged joints.
std::vector<Column> jointColumns(const SynchroniserConfiguration& configuration, const std::vector<std::string>& joints,
                                 const std::vector<std::size_t>& merged);

/// Makes the names portable and unique; returns the original names of those that changed.
std::map<std::string, std::string> makePortable(std::vector<Column>& columns);

}  // namespace demo_logger
