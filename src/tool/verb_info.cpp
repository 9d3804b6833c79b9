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

void inform(const Options& options) {
  nlohmann::ordered_json recordings = nlohmann::ordered_json::array();
  for (const std::filesystem::path& file : findRecordings(options.paths)) {
    const RecordingSummary summary = summarise(file, readDemonstration(file));
    if (options.json) {
      recordings.push_back(toJson(summary));
    } else {
      std::cout << toText(summary);
    }
  }
  if (options.json) {
    std::cout << nlohmann::ordered_json{{"recordings", recordings}}.dump(2) << '\n';
  }
}

}  // namespace

void addInfoVerb(CLI::App& tool, int& exit_code) {
  const auto options = std::make_shared<Options>();
  CLI::App* verb = tool.add_subcommand("info", "what is in recordings");
  verb->add_option("PATH", options->paths, "recordings (*.csv), or directories of them")->required();
  verb->add_flag("--json", options->json, "print one JSON object instead");
  verb->footer("Example: demo_tool info demos/demo_000001.csv");
  verb->callback([options, &exit_code] {
    inform(*options);
    exit_code = kDone;
  });
}

}  // namespace demo_logger
