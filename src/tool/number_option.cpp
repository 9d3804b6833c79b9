#include "src/tool/number_option.h"

#include <cmath>
#include <cstdlib>

#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/print.h"

namespace demo_logger {
namespace {

std::string describe(const NumberRange& range) {
  const std::string lower = print(range.lower);
  const bool below = std::isfinite(range.upper), above = std::isfinite(range.lower);
  if (above && below && range.lower_included) return "from " + lower + " to " + print(range.upper);
  if (above && below) return "above " + lower + ", at most " + print(range.upper);
  if (above) return (range.lower_included ? "of at least " : "above ") + lower;
  return below ? "of at most " + print(range.upper) : "";
}

bool holds(const NumberRange& range, double number) {
  if (!std::isfinite(number) || number > range.upper) return false;
  return range.lower_included ? number >= range.lower : number > range.lower;
}

}  // namespace

NumberRange positive(const std::string& unit) {
  NumberRange range;
  range.unit = unit;
  range.lower = 0.0;
  range.lower_included = false;
  return range;
}

void requireNumber(CLI::Option& option, const NumberRange& range) {
  const std::string name = option.get_name();
  const std::string where = describe(range);
  const std::string expected =
      std::string(range.whole ? "a whole number" : "a finite number") + (where.empty() ? "" : " ") + where;
  const auto judge = [name, range, expected](const std::string& text) -> std::string {
    char* end = nullptr;
    const double number = std::strtod(text.c_str(), &end);
    const bool is_number = end != text.c_str() && *end == '\0';
    const bool digits_alone = text.find_first_not_of("0123456789") == std::string::npos;
    if (is_number && holds(range, number) && (!range.whole || digits_alone)) return "";
    const std::string found = !is_number ? "\"" + text + "\"" : text + (range.unit.empty() ? "" : " " + range.unit);
    throw ConfigurationError(name + " is " + found + ", expected " + expected);
  };
  option.check(judge, where);
}

void addJobsOption(CLI::App& verb, unsigned& jobs, const std::string& description) {
  NumberRange range;
  range.lower = 1.0;
  range.upper = 256.0;
  range.whole = true;
  requireNumber(*verb.add_option("--jobs", jobs, description)->capture_default_str(), range);
}

}  // namespace demo_logger
