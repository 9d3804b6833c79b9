#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "test/tool/temporary_directory.h"

namespace demo_logger {

/// demo_tool in a directory of its own, as a user's shell sees it.
class ToolRun {
 public:
  struct Outcome {
    int exit_code = -1;
    std::string out;
    std::string err;
  };

  std::string path(const std::string& name) const { return (directory_ / name).string(); }

  void write(const std::string& name, const std::string& text) const { std::ofstream(path(name)) << text; }

  std::string read(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(path(name)).rdbuf();
    return text.str();
  }

  /// The lines of a CSV as cells.
  std::vector<std::vector<std::string>> cells(const std::string& name) const {
    std::vector<std::vector<std::string>> table;
    std::istringstream lines(read(name));
    for (std::string line; std::getline(lines, line);) {
      std::istringstream cells(line);
      table.emplace_back();
      for (std::string cell; std::getline(cells, cell, ',');) table.back().push_back(cell);
    }
    return table;
  }

  bool exists(const std::string& name) const { return std::filesystem::exists(path(name)); }

  Outcome operator()(const std::string& arguments) const {
    const std::string command = "cd " + directory_.path().string() + " && " + DEMO_TOOL + " " + arguments + " >" +
                                path("out") + " 2>" + path("err");
    Outcome outcome;
    outcome.exit_code = WEXITSTATUS(std::system(command.c_str()));
    outcome.out = read("out");
    outcome.err = read("err");
    return outcome;
  }

 private:
  TemporaryDirectory directory_;
};

}  // namespace demo_logger
