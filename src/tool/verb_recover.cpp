#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "demo_logger/recording/episode_writer.h"
#include "demo_logger/trajectory/error.h"
#include "src/tool/verbs.h"

namespace demo_logger {
namespace {

struct Options {
  std::vector<std::string> directories;
  bool json = false;
};

void print(const Recovered& recovered) {
  std::cout << recovered.file.string() << ": " << recovered.rows << " rows, interrupted: killed";
  if (recovered.dropped_bytes > 0) {
    std::cout << "; " << recovered.dropped_bytes << " bytes of an incomplete row dropped";
  }
  std::cout << '\n';
}

void recoverAll(const Options& options) {
  for (const std::string& directory : options.directories) {
    if (!std::filesystem::is_directory(directory)) {
      throw FileError(directory + ": no such directory");
    }
  }
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const std::string& directory : options.directories) {
    for (const Recovered& recovered : recover(directory)) {
      all.push_back(
          {{"file", recovered.file.string()}, {"rows", recovered.rows}, {"dropped_bytes", recovered.dropped_bytes}});
      if (!options.json) {
        print(recovered);
      }
    }
  }
  if (options.json) {
    std::cout << nlohmann::ordered_json{{"recovered", all}}.dump(2) << '\n';
  } else if (all.empty()) {
    std::cout << "nothing to recover\n";
  }
}

}  // namespace

void addRecoverVerb(CLI::App& tool, int& exit_code) {
  const auto options = std::make_shared<Options>();
  CLI::App* verb = tool.add_subcommand("recover", "finish what a killed recorder left (*.part)");
  verb->add_option("PATH", options->directories, "directories of recordings; an open episode is left alone")
      ->required();
  verb->add_flag("--json", options->json, "print one JSON object instead");
  verb->footer("Example: demo_tool recover demos");
  verb->callback([options, &exit_code] {
    recoverAll(*options);
    exit_code = kDone;
  });
}

}  // namespace demo_logger
