#include "demo_logger/formats/column_conventions.h"

#include <array>
#include <set>
#include <string_view>

namespace demo_logger {
namespace {

constexpr std::string_view kAge = "_age";

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

// What the last word of a name says of its unit.
constexpr std::array<Convention, 19> kLastWords = {{
    {"_vx", "m/s", Role::control, Interpolation::linear},   {"_vy", "m/s", Role::control, Interpolation::linear},
    {"_vz", "m/s", Role::control, Interpolation::linear},   {"_wx", "rad/s", Role::control, Interpolation::linear},
    {"_wy", "rad/s", Role::control, Interpolation::linear}, {"_wz", "rad/s", Role::control, Interpolation::linear},
    {"_fx", "N", Role::auxiliary, Interpolation::linear},   {"_fy", "N", Role::auxiliary, Interpolation::linear},
    {"_fz", "N", Role::auxiliary, Interpolation::linear},   {"_tx", "N m", Role::auxiliary, Interpolation::linear},
    {"_ty", "N m", Role::auxiliary, Interpolation::linear}, {"_tz", "N m", Role::auxiliary, Interpolation::linear},
    {"_x", "m", Role::control, Interpolation::linear},      {"_y", "m", Role::control, Interpolation::linear},
    {"_z", "m", Role::control, Interpolation::linear},      {"_rx", "rad", Role::control, Interpolation::linear},
    {"_ry", "rad", Role::control, Interpolation::linear},   {"_rz", "rad", Role::control, Interpolation::linear},
    {"_value", "", Role::auxiliary, Interpolation::hold},
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

// A stream `hand` has an age, `hand_age`; its columns are a command in force until replaced, unless they are
// measurements or buttons.
bool belongsToStream(std::string_view name, const std::set<std::string>& streams) {
  for (std::size_t end = name.find('_'); end != std::string_view::npos; end = name.find('_', end + 1)) {
    if (streams.count(std::string(name.substr(0, end))) > 0) {
      return true;
    }
  }
  return false;
}

Column describe(const std::string& name, const std::set<std::string>& streams) {
  Column column{name, "", Role::auxiliary, Interpolation::none, ""};
  if (name == "time" || name == "receipt_delay" || endsWith(name, kAge)) {
    column.unit = "s";
    return column;
  }
  for (const Convention& convention : kJointPrefixes) {
    if (startsWith(name, convention.word)) {
      return {name, convention.unit, convention.role, convention.interpolation, ""};
    }
  }
  const bool is_stream = belongsToStream(name, streams);
  Role stream_role = isJoyComponent(name) ? Role::auxiliary : Role::control;
  for (const Convention& convention : kLastWords) {
    if (endsWith(name, convention.word)) {
      column.unit = convention.unit;
      column.interpolation = convention.interpolation;
      stream_role = convention.role;
      break;
    }
  }
  if (startsWith(name, "ee_")) {
    column.role = Role::state;
  } else if (is_stream || startsWith(name, "u_")) {
    column.role = startsWith(name, "u_") ? Role::control : stream_role;
    column.interpolation = Interpolation::hold;
  } else if (isJoyComponent(name)) {
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
  std::set<std::string> streams;
  for (const std::string& name : names) {
    if (endsWith(name, kAge)) {
      streams.insert(name.substr(0, name.size() - kAge.size()));
    }
  }
  std::vector<Column> columns;
  columns.reserve(names.size());
  for (const std::string& name : names) {
    columns.push_back(describe(name, streams));
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (isOrientation(names, i)) {
      for (std::size_t k = i; k < i + 4; ++k) {
        if (columns[k].interpolation != Interpolation::hold) {  // a command's orientation stays in force as well
          columns[k].interpolation = Interpolation::slerp;
        }
      }
    }
  }
  return columns;
}

}  // namespace demo_logger
