#include "demo_logger/formats/column_conventions.h"

#include <array>
#include <string_view>

namespace demo_logger {
namespace {

struct Convention {
  std::string_view word;
  const char* unit;
  Role role;
  Interpolation interpolation;
};

// The longer of two prefixes stands first.
constexpr std::array<Convention, 6> kJointPrefixes = {{
    {"ddq_", "rad/s^2", Role::auxiliary, Interpolation::linear},
    {"dq_", "rad/s", Role::state, Interpolation::linear},
    {"q_", "rad", Role::state, Interpolation::linear},
    {"tau_h_std_", "N m", Role::auxiliary, Interpolation::linear},
    {"tau_h_", "N m", Role::auxiliary, Interpolation::linear},
    {"tau_", "N m", Role::auxiliary, Interpolation::linear},
}};

// Of streams. A stream is in force until replaced, unless it is a pose.
constexpr std::array<Convention, 20> kStreamSuffixes = {{
    {"_age", "s", Role::auxiliary, Interpolation::none},    {"_vx", "m/s", Role::auxiliary, Interpolation::hold},
    {"_vy", "m/s", Role::auxiliary, Interpolation::hold},   {"_vz", "m/s", Role::auxiliary, Interpolation::hold},
    {"_wx", "rad/s", Role::auxiliary, Interpolation::hold}, {"_wy", "rad/s", Role::auxiliary, Interpolation::hold},
    {"_wz", "rad/s", Role::auxiliary, Interpolation::hold}, {"_fx", "N", Role::auxiliary, Interpolation::hold},
    {"_fy", "N", Role::auxiliary, Interpolation::hold},     {"_fz", "N", Role::auxiliary, Interpolation::hold},
    {"_tx", "N m", Role::auxiliary, Interpolation::hold},   {"_ty", "N m", Role::auxiliary, Interpolation::hold},
    {"_tz", "N m", Role::auxiliary, Interpolation::hold},   {"_x", "m", Role::auxiliary, Interpolation::linear},
    {"_y", "m", Role::auxiliary, Interpolation::linear},    {"_z", "m", Role::auxiliary, Interpolation::linear},
    {"_rx", "rad", Role::auxiliary, Interpolation::linear}, {"_ry", "rad", Role::auxiliary, Interpolation::linear},
    {"_rz", "rad", Role::auxiliary, Interpolation::linear}, {"_value", "", Role::auxiliary, Interpolation::hold},
}};

bool startsWith(std::string_view name, std::string_view prefix) { return name.substr(0, prefix.size()) == prefix; }

bool endsWith(std::string_view name, std::string_view suffix) {
  return name.size() >= suffix.size() && name.substr(name.size() - suffix.size()) == suffix;
}

bool isJoyComponent(std::string_view name) {
  for (const std::string_view component : {"_axis", "_button"}) {
    const std::size_t digits = name.rfind(component);
    if (digits != std::string_view::npos && digits + component.size() < name.size() &&
        name.find_first_not_of("0123456789", digits + component.size()) == std::string_view::npos) {
      return true;
    }
  }
  return false;
}

Column describe(const std::string& name) {
  const auto asStated = [&name](const Convention& convention) {
    return Column{name, convention.unit, convention.role, convention.interpolation, ""};
  };
  if (name == "time" || name == "receipt_delay") {
    return {name, "s", Role::auxiliary, Interpolation::none, ""};
  }
  for (const Convention& convention : kJointPrefixes) {
    if (startsWith(name, convention.word)) {
      return asStated(convention);
    }
  }
  Column column{name, "", Role::auxiliary, Interpolation::none, ""};
  for (const Convention& convention : kStreamSuffixes) {
    if (endsWith(name, convention.word)) {
      column = asStated(convention);
      break;
    }
  }
  if (isJoyComponent(name)) {
    column.interpolation = Interpolation::hold;
  }
  if (startsWith(name, "ee_")) {
    column.role = Role::state;
  } else if (startsWith(name, "u_") && name != "u_age") {
    column.role = Role::control;
    column.interpolation = Interpolation::hold;
  }
  return column;
}

bool isOrientation(const std::vector<std::string>& names, std::size_t first) {
  if (first + 4 > names.size() || !endsWith(names[first], "_qx")) {
    return false;
  }
  const std::string stem = names[first].substr(0, names[first].size() - 1);
  return names[first + 1] == stem + "y" && names[first + 2] == stem + "z" && names[first + 3] == stem + "w";
}

}  // namespace

std::vector<Column> describeColumns(const std::vector<std::string>& names) {
  std::vector<Column> columns;
  columns.reserve(names.size());
  for (const std::string& name : names) {
    columns.push_back(describe(name));
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (isOrientation(names, i)) {
      for (std::size_t k = i; k < i + 4; ++k) {
        // A commanded orientation stays in force until replaced, like any other command.
        columns[k].interpolation = columns[k].role == Role::control ? Interpolation::hold : Interpolation::slerp;
      }
    }
  }
  return columns;
}

}  // namespace demo_logger
