#include "src/nodes/terminal.h"

#include <unistd.h>

#include "demo_logger/trajectory/error.h"

namespace demo_logger {

Terminal::Terminal() {
  if (tcgetattr(STDIN_FILENO, &before_) != 0) {
    throw Error(
        "standard input is not a terminal, expected one to read keys from; start it with rosrun in a terminal, "
        "or in a launch file with launch-prefix=\"xterm -e\".");
  }
  termios keyboard = before_;
  keyboard.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  keyboard.c_cc[VMIN] = 0;
  keyboard.c_cc[VTIME] = 0;
  keyboard.c_cc[VSUSP] = _POSIX_VDISABLE;
  tcsetattr(STDIN_FILENO, TCSANOW, &keyboard);
}

Terminal::~Terminal() { tcsetattr(STDIN_FILENO, TCSANOW, &before_); }

std::string Terminal::read() {
  char keys[64];
  const ssize_t count = ::read(STDIN_FILENO, keys, sizeof keys);
  return count > 0 ? std::string(keys, static_cast<std::size_t>(count)) : "";
}

}  // namespace demo_logger
