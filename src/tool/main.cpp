#include <exception>
#include <iostream>

#include "src/ros/version.h"
#include "src/tool/verbs.h"

int main(int argc, char** argv) {
  using namespace demo_logger;
  int exit_code = kDone;
  try {
    CLI::App tool{"Works on recorded demonstrations: brings them in, shows them, checks them."};
    tool.set_version_flag("--version", kSoftware);
    tool.require_subcommand(1);
    tool.footer(
        "Example: demo_tool import teleoperation.bag -o demos && demo_tool info demos\n"
        "Exit code: 0 done; 1 done, with findings; 2 not done, nothing written.");
    addImportVerb(tool, exit_code);
    addInfoVerb(tool, exit_code);
    addCheckVerb(tool, exit_code);
    addRecoverVerb(tool, exit_code);
    addKinematicsVerb(tool, exit_code);
    addIkVerb(tool, exit_code);
    addTorqueVerb(tool, exit_code);
    try {
      tool.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      return tool.exit(error) == 0 ? kDone : kNotDone;
    }
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return kNotDone;
  }
  return exit_code;
}
