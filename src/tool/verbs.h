#pragma once

#include <CLI/CLI.hpp>

namespace demo_logger {

/// How a verb ended; what demo_tool returns to the shell.
enum ExitCode {
  kDone = 0,
  kFindings = 1,  // done, with findings or unsolved rows
  kNotDone = 2,   // usage, unreadable, refused: nothing written
};

// Each verb adds itself to the command line and runs when it is named there, leaving its exit code. It throws Error for
// what it refuses.
void addImportVerb(CLI::App& tool, int& exit_code);
void addInfoVerb(CLI::App& tool, int& exit_code);
void addCheckVerb(CLI::App& tool, int& exit_code);
void addRecoverVerb(CLI::App& tool, int& exit_code);
void addKinematicsVerb(CLI::App& tool, int& exit_code);
void addIkVerb(CLI::App& tool, int& exit_code);
void addTorqueVerb(CLI::App& tool, int& exit_code);

}  // namespace demo_logger
