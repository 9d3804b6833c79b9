#pragma once

#include <string>
#include <vector>

namespace demo_logger {

/// The at most three of `names` that are most like `name` (fewest letters to change), as 'a', 'b', 'c': what to offer
/// to someone who mistyped. Equal likeness keeps the order given.
std::string nearNames(const std::string& name, const std::vector<std::string>& names);

/// 'a', 'b', 'c'; past `limit` names only how many more there are.
std::string quotedList(const std::vector<std::string>& names, std::size_t limit = 12);

}  // namespace demo_logger
