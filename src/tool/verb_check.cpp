#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "demo_logger/formats/demonstration_file.h"
#include "demo_logger/pipelines/check.h"
#include "src/tool/recordings.h"
#include "src/tool/verbs.h"

namespace demo_logger {
namespace {

using nlohmann::ordered_json;

struct Options {
  std::vector<std::string> paths;
  bool json = false;
};

const char* nameOf(Severity severity) { return severity == Severity::error ? "error" : "warning"; }

ordered_json toJson(const std::string& file, const CheckResult& result, const std::vector<std::string>& notes) {
  ordered_json findings = ordered_json::array();
  for (const Finding& finding : result.findings) {
    findings.push_back(
        {{"kind", finding.kind}, {"severity", nameOf(finding.severity)}, {"sentence", finding.sentence}});
  }
  return {{"file", file}, {"findings", findings}, {"notes", notes}};
}

void print(const std::string& file, const CheckResult& result, const std::vector<std::string>& notes) {
  for (const std::string& note : notes) {
    std::cout << file << ": note: " << note << '\n';
  }
  for (const Finding& finding : result.findings) {
    std::cout << file << ": " << nameOf(finding.severity) << ": " << finding.sentence << '\n';
  }
  if (result.findings.empty()) {
    std::cout << file << ": nothing found wrong in " << result.summary.rows << " rows\n";
  }
}

int checkAll(const Options& options) {
  return lookAtRecordings(options.paths, options.json, [&](const std::filesystem::path& file) -> Looked {
    const LoadedDemonstration loaded = readDemonstration(file);
    const CheckResult result = check(loaded.demonstration);
    if (!options.json) {
      print(file.string(), result, loaded.notes);
    }
    return {result.findings.empty() ? kDone : kFindings, toJson(file.string(), result, loaded.notes)};
  });
}

}  // namespace

void addCheckVerb(CLI::App& tool, int& exit_code) {
  const auto options = std::make_shared<Options>();
  CLI::App* verb = tool.add_subcommand("check", "what is wrong with recordings, in sentences");
  verb->add_option("PATH", options->paths, "recordings (*.csv), or directories of them")->required();
  verb->add_flag("--json", options->json, "print one JSON object instead");
  verb->footer("Example: demo_tool check demos\nExit code: 1 if anything was found.");
  verb->callback([options, &exit_code] { exit_code = checkAll(*options); });
}

}  // namespace demo_logger
