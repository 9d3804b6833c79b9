#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace demo_logger {

/// What a column is for those who learn from it: x (state), u (control), or anything else (auxiliary).
enum class Role { state, control, auxiliary };

/// How a column may be resampled: `linear`; `slerp` for the four components of a unit quaternion x y z w,
/// which stand in consecutive columns; `hold` for what stays in force until replaced; `none` for ages and the like.
enum class Interpolation { linear, slerp, hold, none };

/// One named series of a demonstration.
struct Column {
  std::string name;  // as in the header of the CSV
  std::string unit;  // "rad", "m/s", "N m", "s", "" for a pure number
  Role role = Role::auxiliary;
  Interpolation interpolation = Interpolation::none;
  std::string source;  // what it was made from: "joint_states/position/elbow"
};

/// The words used in files: "state", "slerp", ….
const char* toString(Role role);
const char* toString(Interpolation interpolation);

/// Nothing for a word that is none of them.
std::optional<Role> roleFromString(std::string_view word);
std::optional<Interpolation> interpolationFromString(std::string_view word);

}  // namespace demo_logger
