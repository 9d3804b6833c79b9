#include <gtest/gtest.h>

#include <cstdlib>

#include "test/nodes/node_process.h"
#include "test/tool/temporary_directory.h"

// What demo_logger_node says where there is no ROS master.

namespace demo_logger {
namespace {

TEST(DemoLoggerStartTest, WithoutAMasterItSaysSoInOneLineAndEndsWithOne) {
  const TemporaryDirectory directory;
  setenv("ROS_MASTER_URI", "http://localhost:1", 1);  // tcpmux, which nobody runs
  setenv("ROS_HOME", directory.path().c_str(), 1);
  NodeProcess node({DEMO_LOGGER_NODE, "_output_dir:=" + (directory / "demos").string()}, (directory / "log").string());
  EXPECT_EQ(node.wait(), 1);
  EXPECT_EQ(
      node.output(),
      "demo_logger: no ROS master answers at http://localhost:1; start one with roscore, or set ROS_MASTER_URI to "
      "the one that runs.\n");
  EXPECT_FALSE(std::filesystem::exists(directory / "demos"));
}

}  // namespace
}  // namespace demo_logger
