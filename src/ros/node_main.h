#pragma once

#include <functional>
#include <string>

namespace demo_logger {

/// The outermost shell of every node: initialises ROS as `name`, makes sure that a master answers, runs `body`, and
/// turns whatever it throws into one sentence on stderr. SIGTERM and SIGHUP end the node as SIGINT does: ros::ok()
/// becomes false, and `body` returns. Returns what main returns: 0, or 1 after an error.
int runNode(int argc, char** argv, const std::string& name, const std::function<void()>& body);

}  // namespace demo_logger
