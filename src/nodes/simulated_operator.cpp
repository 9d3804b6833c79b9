#include "src/nodes/simulated_operator.h"

namespace demo_logger {
namespace {

constexpr double kMostButtons = 63.0;
constexpr double kMostListeners = 10.0;

}  // namespace

OperatorButtons readOperatorButtons(Parameters& parameters) {
  const Range range{-1.0, kMostButtons, ""};
  OperatorButtons buttons;
  buttons.start = parameters.integer("start_button", buttons.start, range);
  buttons.stop = parameters.integer("stop_button", buttons.stop, range);
  return buttons;
}

std::uint32_t readListeners(Parameters& parameters, std::uint32_t fallback) {
  return static_cast<std::uint32_t>(
      parameters.integer("listeners", static_cast<int>(fallback), {0.0, kMostListeners, ""}));
}

ros::WallTimer remindOfWaiting(const ros::NodeHandle& node, const ros::Publisher& joy, std::uint32_t listeners,
                               const std::string& for_what, const std::function<bool()>& waits) {
  return node.createWallTimer(ros::WallDuration(kReminderPeriod), [=](const ros::WallTimerEvent&) {
    if (!waits()) return;
    ROS_WARN_STREAM("waiting for " << for_what << " and for " << listeners << " nodes that listen to " << joy.getTopic()
                                   << ", now " << joy.getNumSubscribers() << ".");
  });
}

void endWithTask() {
  ROS_INFO("the task is done.");
  ros::requestShutdown();
}

}  // namespace demo_logger
