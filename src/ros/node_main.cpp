#include "src/ros/node_main.h"

#include <ros/init.h>
#include <ros/master.h>

#include <csignal>
#include <cstdio>
#include <exception>

#include "demo_logger/trajectory/error.h"

namespace demo_logger {
namespace {

void requestShutdown(int /*signal*/) { ros::requestShutdown(); }

}  // namespace

int runNode(int argc, char** argv, const std::string& name, const std::function<void()>& body) {
  try {
    ros::init(argc, argv, name);
    if (!ros::master::check()) {
      throw Error("no ROS master answers at " + ros::master::getURI() +
                  "; start one with roscore, or set ROS_MASTER_URI to the one that runs.");
    }
    std::signal(SIGTERM, requestShutdown);
    std::signal(SIGHUP, requestShutdown);
    body();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", name.c_str(), error.what());
    return 1;
  }
  return 0;
}

}  // namespace demo_logger
