#pragma once

#include <CLI/CLI.hpp>
#include <limits>
#include <string>

namespace demo_logger {

/// What a number on the command line may be; always finite.
struct NumberRange {
  std::string unit;
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool lower_included = true;  // false: above `lower`
  bool whole = false;
};

/// Above 0, without end.
NumberRange positive(const std::string& unit);

/// From now on the option takes nothing but a number within `range`, and --help says so. Anything else is refused by a
/// ConfigurationError, before CLI11 would convert it:
///   --rate is inf Hz, expected a finite number above 0
void requireNumber(CLI::Option& option, const NumberRange& range);

/// --jobs, how many threads share the work: 1 to 256.
void addJobsOption(CLI::App& verb, unsigned& jobs, const std::string& description);

}  // namespace demo_logger
