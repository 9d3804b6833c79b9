#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "src/tool/recording_summary.h"
#include "src/tool/recordings.h"
#include "src/tool/verbs.h"

namespace demo_logger {
namespace {

struct Options {
  std::vector<std::string> paths;
  bool json = false;
};

int inform(const Options& options) {
  return lookAtRecordings(options.paths, options.json, [&](const std::filesystem::path& file) -> Looked {
    const RecordingSummary summary = summarise(file, readDemonstration(file));
    if (!options.json) {
      std::cout << toText(summary);
    }
    return {kDone, toJson(summary)};
  });
}

}  // namespace

void addInfoVerb(CLI::App& tool, int& exit_code) {
  const auto options = std::make_shared<Options>();
  CLI::App* verb = tool.add_subcommand("info", "what is in recordings");
  verb->add_option("PATH", options->paths, "recordings (*.csv), or directories of them")->required();
  verb->add_flag("--json", options->json, "print one JSON object instead");
  verb->footer("Example: demo_tool info demos/demo_000001.csv");
  verb->callback([options, &exit_code] { exit_code = inform(*options); });
}

}  // namespace demo_logger
