#pragma once

#include <termios.h>

#include <string>

namespace demo_logger {

/// Standard input as a keyboard: keys come at once and are not echoed, until the object goes. Ctrl-C still interrupts;
/// Ctrl-Z does not stop the process, which would leave the shell with such a keyboard.
class Terminal {
 public:
  /// Throws Error if standard input is no terminal.
  Terminal();
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// The keys pressed since the last call; does not wait.
  std::string read();

 private:
  termios before_;
};

}  // namespace demo_logger
