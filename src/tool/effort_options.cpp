#include "src/tool/effort_options.h"

#include <vector>

#include "demo_logger/trajectory/print.h"
#include "src/tool/number_option.h"

namespace demo_logger {

void addEffortOptions(CLI::App& verb, EffortOptions& options, const std::string& otherwise) {
  const std::string by_default = " (default: " + otherwise + ")";
  verb.add_option("--effort", options.timing,
                  "instant: efforts were measured at the stamp; held: they are commands, in force until the next tick" +
                      by_default)
      ->check(CLI::IsMember({"instant", "held"}));
  verb.add_option("--side", options.side, "of the gears that efforts were measured on" + by_default)
      ->check(CLI::IsMember({"motor", "link"}));
  requireNumber(*verb.add_option("--control-period", options.control_period,
                                 "[s] of the arm's controller, for held efforts" + by_default),
                {"s", 0.0, 1.0, /*lower_included=*/false});
}

EffortMetadata corrected(EffortMetadata recorded, const EffortOptions& options) {
  if (!options.timing.empty()) recorded.timing = options.timing;
  if (!options.side.empty()) recorded.side = options.side;
  if (options.control_period) recorded.control_period = *options.control_period;
  return recorded;
}

bool saysWhatEffortsMean(const Metadata& recorded) {
  const EffortMetadata unsaid;
  const EffortMetadata& effort = recorded.effort;
  if (effort.side != unsaid.side || effort.timing != unsaid.timing || effort.control_period != unsaid.control_period) {
    return true;
  }
  const bool is_foreign = recorded.software.empty() && recorded.robot.joints.empty();
  return !is_foreign && recorded.provenance.steps != std::vector<std::string>{kImportStep};
}

std::string stepOf(const EffortOptions& options) {
  std::string step;
  if (!options.timing.empty()) step += " --effort " + options.timing;
  if (!options.side.empty()) step += " --side " + options.side;
  if (options.control_period) step += " --control-period " + print(*options.control_period);
  return step;
}

}  // namespace demo_logger
