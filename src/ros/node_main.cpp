#include "src/ros/node_main.h"

#include <XmlRpcClient.h>
#include <XmlRpcValue.h>
#include <ros/init.h>
#include <ros/network.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string_view>

#include "demo_logger/trajectory/error.h"

namespace demo_logger {
namespace {

void requestShutdown(int /*signal*/) { ros::requestShutdown(); }

/// Where ros::init will look for the master.
std::string masterUri(int argc, char** argv) {
  constexpr std::string_view kRemap = "__master:=";
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument.substr(0, kRemap.size()) == kRemap) {
      return std::string(argument.substr(kRemap.size()));
    }
  }
  const char* uri = std::getenv("ROS_MASTER_URI");
  return uri == nullptr ? "http://localhost:11311" : uri;
}

bool answers(const std::string& uri) {
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(uri, host, port)) {
    return false;
  }
  XmlRpc::XmlRpcValue caller;
  XmlRpc::XmlRpcValue reply;
  caller[0] = "demo_logger";
  XmlRpc::XmlRpcClient master(host.c_str(), static_cast<int>(port), "/");
  const bool answered = master.execute("getPid", caller, reply);
  master.close();
  return answered;
}

/// Asked before ros::init, which waits for ever for a master as soon as a parameter stands on the command line.
void requireMaster(const std::string& uri) {
  if (!answers(uri)) {
    throw Error("no ROS master answers at " + uri +
                "; start one with roscore, or set ROS_MASTER_URI to the one that runs.");
  }
}

}  // namespace

int runNode(int argc, char** argv, const std::string& name, const std::function<void()>& body) {
  try {
    requireMaster(masterUri(argc, argv));
    ros::init(argc, argv, name);
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
