#include <ros/callback_queue.h>
#include <ros/init.h>
#include <ros/master.h>

#include <csignal>

#include "demo_logger/trajectory/error.h"
#include "src/nodes/demo_logger_node.h"
#include "src/ros/node_main.h"

namespace {

volatile std::sig_atomic_t stop_requested = 0;

void requestStop(int /*signal*/) { stop_requested = 1; }

/// ROS would disconnect the topics first; the episode is closed before, with all that has arrived.
void closeBeforeRosDoes() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    std::signal(signal, requestStop);
  }
}

/// Asked twice a second, lost when it has not answered twice.
class MasterWatch {
 public:
  bool lost() {
    const ros::SteadyTime now = ros::SteadyTime::now();
    if ((now - asked_).toSec() > 0.5) {
      asked_ = now;
      silent_ = ros::master::check() ? 0 : silent_ + 1;
    }
    return silent_ >= 2;
  }

 private:
  ros::SteadyTime asked_ = ros::SteadyTime::now();
  int silent_ = 0;
};

void recordUntilStopped() {
  const ros::NodeHandle node;
  const ros::NodeHandle private_node("~");
  demo_logger::DemoLoggerNode recorder(node, private_node, demo_logger::readDemoLoggerParameters(node, private_node));
  closeBeforeRosDoes();
  MasterWatch master;
  while (ros::ok() && stop_requested == 0 && !master.lost()) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.05));
  }
  const demo_logger::Reply reply = recorder.close();
  if (!reply.success) {
    throw demo_logger::FileError(reply.message);
  }
}

}  // namespace

int main(int argc, char** argv) { return demo_logger::runNode(argc, argv, "demo_logger", recordUntilStopped); }
