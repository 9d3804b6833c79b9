#include <XmlRpcClient.h>
#include <XmlRpcValue.h>
#include <arpa/inet.h>
#include <ros/master.h>
#include <ros/network.h>
#include <sys/socket.h>

#include "test/nodes/recorder_under_test.h"

// However the node ends, what it has received is in the file.

namespace demo_logger {
namespace {

class EndingTest : public RecorderUnderTest {
 protected:
  void expectWholeEpisode() {
    EXPECT_EQ(process_->wait(), 0) << process_->output();
    expectCounting(read("demo_000001"), 0, static_cast<std::size_t>(moved_));
    EXPECT_EQ(read("demo_000001").metadata.status, "complete");
    EXPECT_FALSE(std::filesystem::exists(output("demo_000001.csv.part")));
  }

  void record() {
    start();
    move(100);
    ASSERT_TRUE(waitForRows(100));
  }
};

TEST_F(EndingTest, AnInterruptClosesTheEpisode) {
  record();
  process_->signal(SIGINT);
  expectWholeEpisode();
}

TEST_F(EndingTest, ATerminationClosesTheEpisode) {
  record();
  process_->signal(SIGTERM);
  expectWholeEpisode();
}

TEST_F(EndingTest, AShutdownRequestAsOfRosnodeKillClosesTheEpisode) {
  record();
  XmlRpc::XmlRpcValue request;
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue uri;
  request[0] = ros::this_node::getName();
  request[1] = namespace_ + "/demo_logger";
  ASSERT_TRUE(ros::master::execute("lookupNode", request, response, uri, false));
  std::string host;
  std::uint32_t port = 0;
  ASSERT_TRUE(ros::network::splitURI(static_cast<std::string>(uri), host, port));
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port));
  XmlRpc::XmlRpcValue shutdown;
  shutdown[0] = ros::this_node::getName();
  shutdown[1] = "asked to by a test";
  ASSERT_TRUE(client.execute("shutdown", shutdown, response));
  expectWholeEpisode();
}

TEST_F(EndingTest, AKillLeavesPartsThatTheNextStartFinishes) {
  record();
  process_->signal(SIGKILL);
  EXPECT_EQ(process_->wait(), -SIGKILL);
  EXPECT_TRUE(std::filesystem::exists(output("demo_000001.csv.part")));
  statuses_.clear();
  start();
  const Demonstration saved = read("demo_000001");
  EXPECT_EQ(saved.metadata.status, "interrupted: killed");
  EXPECT_EQ(saved.time.size(), 100U) << "all rows that the status had named";
  EXPECT_NE(process_->output().find("saved what a killed recorder had left: " + output("demo_000001.csv")),
            std::string::npos)
      << process_->output();
}

TEST_F(EndingTest, AnEpisodeThatCannotBeSavedIsNotCalledASuccess) {
  record();
  std::filesystem::remove_all(output(""));
  process_->signal(SIGINT);
  EXPECT_EQ(process_->wait(), 1);
  EXPECT_NE(process_->output().find("Was it moved or removed while it was recorded?"), std::string::npos)
      << process_->output();
}

TEST_F(EndingTest, AFaultIsSaidOnceOnTheConsole) {
  start();
  for (int i = 0; i < 3; ++i) {
    move(20);
    sensor_msgs::JointState partial = makeJointState(ros::Time::now());
    --moved_;
    partial.name.pop_back();
    partial.position.pop_back();
    joint_states_.publish(partial);
  }
  ASSERT_TRUE(waitForRows(60));
  process_->signal(SIGINT);
  EXPECT_EQ(process_->wait(), 0);
  const std::string said = process_->output();
  EXPECT_NE(said.find("lack joint_2"), std::string::npos) << said;
  EXPECT_NE(said.find("merge_joint_states"), std::string::npos) << said;
  EXPECT_EQ(said.find("merge_joint_states", said.find("merge_joint_states") + 1), std::string::npos) << said;
}

TEST_F(EndingTest, AStopOfASecondInTheMiddleLosesNothing) {
  record();
  process_->signal(SIGSTOP);
  move(500);  // a second at 500 Hz that the node sleeps through
  process_->signal(SIGCONT);
  move(100);
  ASSERT_TRUE(waitForRows(700));
  process_->signal(SIGINT);
  expectWholeEpisode();
}

/// A port that nobody listens on at this moment.
std::uint16_t freePort() {
  const int listener = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  bind(listener, reinterpret_cast<sockaddr*>(&address), size);
  getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size);
  close(listener);
  return ntohs(address.sin_port);
}

bool masterAnswers(int port) {
  XmlRpc::XmlRpcClient master("localhost", port, "/");
  XmlRpc::XmlRpcValue caller;
  XmlRpc::XmlRpcValue reply;
  caller[0] = "test";
  return master.execute("getPid", caller, reply);
}

TEST_F(EndingTest, ALostMasterClosesTheEpisode) {
  const int port = freePort();
  NodeProcess master({"/usr/bin/python3", "/usr/bin/rosmaster", "--core", "-p", std::to_string(port)},
                     (directory_ / "master").string());
  ASSERT_TRUE(waitUntil([&] { return masterAnswers(port); })) << master.output();
  // The node and a player of joint states live with that master, which then dies.
  const std::string uri = "http://localhost:" + std::to_string(port);
  NodeProcess node({"env", "ROS_MASTER_URI=" + uri, DEMO_LOGGER_NODE, "_output_dir:=" + output("")},
                   (directory_ / "node").string());
  NodeProcess arm({"env", "ROS_MASTER_URI=" + uri, "/usr/bin/python3", "/usr/bin/rostopic", "pub", "-s", "-r", "100",
                   "/joint_states", "sensor_msgs/JointState",
                   "{header: {stamp: now}, name: [joint_1, joint_2], position: [0.5, -0.5]}"},
                  (directory_ / "arm").string());
  const auto holdsRows = [&](const std::string& file) {
    std::error_code none;
    return std::filesystem::file_size(output(file), none) > 1000 && !none;
  };
  ASSERT_TRUE(waitUntil([&] { return holdsRows("demo_000001.csv.part"); })) << node.output() << arm.output();
  master.signal(SIGKILL);
  EXPECT_EQ(node.wait(), 0) << node.output();
  EXPECT_EQ(read("demo_000001").metadata.status, "complete");
}

}  // namespace
}  // namespace demo_logger
