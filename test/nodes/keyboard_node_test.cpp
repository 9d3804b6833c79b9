#include <gtest/gtest.h>
#include <pty.h>
#include <ros/ros.h>
#include <sensor_msgs/Joy.h>
#include <signal.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <string>

#include "test/nodes/waiting.h"

namespace demo_logger {
namespace {

/// keyboard_node at a terminal of its own.
class KeyboardNode {
 public:
  KeyboardNode() {
    const std::string path = std::string(DEMO_LOGGER_NODES) + "/keyboard_node";
    int node_side = -1;
    if (openpty(&terminal_, &node_side, nullptr, nullptr, nullptr) != 0) return;
    child_ = fork();
    if (child_ == 0) {
      setsid();
      dup2(node_side, STDIN_FILENO);
      execl(path.c_str(), path.c_str(), static_cast<char*>(nullptr));
      _exit(127);
    }
    node_side_ = node_side;
  }
  ~KeyboardNode() {
    if (child_ > 0) end(SIGKILL);
    close(node_side_);
    close(terminal_);
  }
  KeyboardNode(const KeyboardNode&) = delete;
  KeyboardNode& operator=(const KeyboardNode&) = delete;

  /// False where no pseudo-terminal can be opened, as in a bare root without /dev/pts.
  bool hasTerminal() const { return child_ > 0; }

  void type(char key) { ASSERT_EQ(write(terminal_, &key, 1), 1); }

  bool echoes() const {
    termios settings{};
    tcgetattr(node_side_, &settings);
    return (settings.c_lflag & ECHO) != 0U;
  }

  /// Returns the exit code, -1 if the signal killed it.
  int end(int signal) {
    if (child_ <= 0) return -1;  // a signal to -1 would be one to every process
    kill(child_, signal);
    int status = 0;
    waitpid(child_, &status, 0);
    child_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  int terminal_ = -1;
  int node_side_ = -1;
  pid_t child_ = -1;
};

TEST(KeyboardNodeTest, KeysBecomeJoyAndTheDeviceIsAlwaysThere) {
  ros::NodeHandle node;
  Listener<sensor_msgs::Joy> joy(node, "joy");
  KeyboardNode keyboard;
  if (!keyboard.hasTerminal()) GTEST_SKIP() << "no pseudo-terminal can be opened here";
  ASSERT_TRUE(joy.wait(2)) << "without any key it says that nothing is pressed";
  EXPECT_EQ(joy.last().axes, std::vector<float>(6, 0.0F));
  EXPECT_EQ(joy.last().buttons, std::vector<int>(10, 0));
  keyboard.type('w');
  EXPECT_TRUE(joy.waitUntil([](const auto& message) { return message.axes[0] == 0.5F && message.buttons[0] == 1; }));
  keyboard.type('3');
  EXPECT_TRUE(joy.waitUntil([](const auto& message) { return message.buttons[3] == 1; }));
}

TEST(KeyboardNodeTest, TheTerminalIsAsItWasAfterEverySignalThatEndsTheNode) {
  ros::NodeHandle node;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    Listener<sensor_msgs::Joy> joy(node, "joy");
    KeyboardNode keyboard;
    if (!keyboard.hasTerminal()) GTEST_SKIP() << "no pseudo-terminal can be opened here";
    ASSERT_TRUE(joy.wait());
    EXPECT_FALSE(keyboard.echoes());
    EXPECT_EQ(keyboard.end(signal), 0) << "signal " << signal;
    EXPECT_TRUE(keyboard.echoes()) << "signal " << signal;
  }
}

}  // namespace
}  // namespace demo_logger
