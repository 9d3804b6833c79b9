#include "row_columns.h"

#include <algorithm>

#include "demo_logger/formats/column_names.h"

namespace demo_logger {
namespace {

struct Quantity {
  const char* prefix;
  const char* name;
  const char* unit;
  const char* prismatic_unit;
  Role role;
};

constexpr Quantity kQuantities[] = {{"q_", "position", "rad", "m", Role::state},
                                    {"dq_", "velocity", "rad/s", "m/s", Role::state},
                                    {"tau_", "effort", "N m", "N", Role::auxiliary}};

}  // namespace

std::vector<Column> jointColumns(const SynchroniserConfiguration& configuration, const std::vector<std::string>& joints,
                                 const std::vector<std::size_t>& merged) {
  const std::vector<std::string>& prismatic = configuration.prismatic_joints;
  std::vector<Column> columns;
  for (const Quantity& quantity : kQuantities) {
    for (const std::string& joint : joints) {
      const bool slides = std::find(prismatic.begin(), prismatic.end(), joint) != prismatic.end();
      columns.push_back({quantity.prefix + joint, slides ? quantity.prismatic_unit : quantity.unit, quantity.role,
                         Interpolation::linear, std::string("joint_states/") + quantity.name + "/" + joint});
    }
  }
  columns.push_back({"receipt_delay", "s", Role::auxiliary, Interpolation::none, "joint_states/receipt_delay"});
  for (const std::size_t joint : merged) {
    columns.push_back(
        {joints[joint] + "_age", "s", Role::auxiliary, Interpolation::none, "joint_states/age/" + joints[joint]});
  }
  return columns;
}

std::map<std::string, std::string> makePortable(std::vector<Column>& columns) {
  std::vector<std::string> originals;
  originals.reserve(columns.size());
  for (const Column& column : columns) originals.push_back(column.name);
  PortableNames portable = makePortable(originals);
  for (std::size_t i = 0; i < columns.size(); ++i) columns[i].name = std::move(portable.names[i]);
  return std::move(portable.original_names);
}

}  // namespace demo_logger
