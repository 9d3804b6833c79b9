#include "demo_logger/trajectory/metadata.h"

#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/print.h"

namespace demo_logger {
namespace {

constexpr double kLongestControlPeriod = 1.0;  // [s]

}  // namespace

void validate(const EffortMetadata& effort) {
  if (effort.side != "motor" && effort.side != "link") {
    throw ConfigurationError("effort: side is \"" + effort.side + "\", expected motor or link.");
  }
  if (effort.timing != "instant" && effort.timing != "held") {
    throw ConfigurationError("effort: timing is \"" + effort.timing + "\", expected instant or held.");
  }
  if (effort.timing == "held" && !(effort.control_period > 0.0)) {
    throw ConfigurationError(
        "effort: control_period is " + print(effort.control_period) +
        " s, expected that of the arm's controller, since its efforts are held: a held effort acts half of it late.");
  }
  if (effort.timing == "held" && effort.control_period > kLongestControlPeriod) {
    throw ConfigurationError("effort: control_period is " + print(effort.control_period) +
                             " s, expected that of the arm's controller, above 0 and at most " +
                             print(kLongestControlPeriod) + " s.");
  }
}

}  // namespace demo_logger
