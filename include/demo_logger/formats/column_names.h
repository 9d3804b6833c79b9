#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace demo_logger {

/// MATLAB accepts no longer names.
constexpr std::size_t kLongestColumnName = 63;

/// Whether a name can be used unquoted in Octave, MATLAB, R, SQL, numpy and pandas: [A-Za-z_][A-Za-z0-9_]*, at most 63
/// characters.
bool isPortable(std::string_view name);

struct PortableNames {
  std::vector<std::string> names;                     // portable, unique, in the order given
  std::map<std::string, std::string> original_names;  // of those that had to change: portable name -> original
};

/// Gives every column a portable name of its own, none of them `time`, which is taken:
///   every character but A-Z a-z 0-9 _ becomes one `_`; a leading digit or an empty name gets `_` in front;
///   a name beyond 63 characters is cut and ends in a hash of the whole; a name already given gets _2, _3, ….
/// Names that are fine already stay, and the first of two equal ones keeps its name.
PortableNames makePortable(const std::vector<std::string>& originals);

}  // namespace demo_logger
