#pragma once

#include <demo_logger/Status.h>
#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "demo_logger/formats/demonstration_file.h"
#include "test/nodes/node_process.h"
#include "test/tool/temporary_directory.h"

namespace demo_logger {

/// Runs callbacks until `condition` holds; false if it does not within the bound.
inline bool waitUntil(const std::function<bool()>& condition, double bound_sec = 20.0) {
  const ros::SteadyTime deadline = ros::SteadyTime::now() + ros::WallDuration(bound_sec);
  while (!condition()) {
    if (ros::SteadyTime::now() > deadline) return false;
    ros::spinOnce();
    ros::WallDuration(0.002).sleep();
  }
  return true;
}

/// One demo_logger_node in a namespace of its own, with an arm of two joints beside it that the test moves.
class RecorderUnderTest : public testing::Test {
 protected:
  RecorderUnderTest()
      : namespace_(std::string("/") + testing::UnitTest::GetInstance()->current_test_info()->name()),
        node_(namespace_),
        joint_states_(node_.advertise<sensor_msgs::JointState>("joint_states", 20000)),
        status_subscriber_(node_.subscribe("demo_logger/status", 100, &RecorderUnderTest::onStatus, this)) {}

  /// Starts the node; `arguments` as on the command line ("_autostart:=false"). Waits until it listens to the arm.
  void start(const std::vector<std::string>& arguments = {}) {
    launch(arguments);
    ASSERT_TRUE(
        waitUntil([&] { return !process_->runs() || (joint_states_.getNumSubscribers() > 0 && !statuses_.empty()); }));
    ASSERT_TRUE(process_->runs()) << process_->output();
  }

  /// As above for a node that listens to other joint states.
  void startBesideTheArm(const std::vector<std::string>& arguments) {
    launch(arguments);
    ASSERT_TRUE(waitUntil([&] { return !process_->runs() || !statuses_.empty(); }));
    ASSERT_TRUE(process_->runs()) << process_->output();
  }

  /// Starts the node without waiting for anything.
  void launch(const std::vector<std::string>& arguments = {}) {
    std::vector<std::string> command = {DEMO_LOGGER_NODE, "__ns:=" + namespace_, "_output_dir:=" + output("")};
    command.insert(command.end(), arguments.begin(), arguments.end());
    process_ = std::make_unique<NodeProcess>(command, (directory_ / "log").string());
  }

  /// The arm moves for `count` joint states at 500 Hz: joint_1 counts the messages of the test.
  void move(int count) {
    ros::WallRate rate(500.0);
    for (int i = 0; i < count; ++i) {
      joint_states_.publish(makeJointState(ros::Time::now()));
      rate.sleep();
      ros::spinOnce();
    }
  }

  sensor_msgs::JointState makeJointState(const ros::Time& stamp) {
    sensor_msgs::JointState message;
    message.header.stamp = stamp;
    message.name = {"joint_1", "joint_2"};
    message.position = {static_cast<double>(moved_), -0.5};
    ++moved_;
    return message;
  }

  /// Until the node has written this many rows of the present episode.
  bool waitForRows(std::uint64_t rows) {
    return waitUntil([&] { return !statuses_.empty() && statuses_.back().rows >= rows; });
  }

  bool waitForState(const std::string& state) {
    return waitUntil([&] { return !statuses_.empty() && statuses_.back().state == state; });
  }

  /// A diagnosis of this node whose message contains `text`.
  bool waitForDiagnosis(const std::string& task, int level, const std::string& text) {
    bool found = false;
    const boost::function<void(const diagnostic_msgs::DiagnosticArray::ConstPtr&)> look =
        [&](const diagnostic_msgs::DiagnosticArray::ConstPtr& array) {
          for (const auto& status : array->status) {
            if (status.name == namespace_.substr(1) + "/demo_logger: " + task ||
                status.name == "demo_logger: " + task) {
              diagnosis_ = status.message;
              found = found || (status.level == level && status.message.find(text) != std::string::npos);
            }
          }
        };
    const ros::Subscriber subscriber = node_.subscribe<diagnostic_msgs::DiagnosticArray>("/diagnostics", 100, look);
    return waitUntil([&] { return found; });
  }

  template <class Service>
  typename Service::Response call(const std::string& name, const typename Service::Request& request = {}) {
    typename Service::Response response;
    const std::string service = node_.resolveName("demo_logger/" + name);
    EXPECT_TRUE(ros::service::waitForService(service, ros::Duration(20.0)));
    typename Service::Request copy = request;
    EXPECT_TRUE(ros::service::call(service, copy, response)) << service;
    return response;
  }

  std::string output(const std::string& file) const { return (directory_ / "demos" / file).string(); }

  Demonstration read(const std::string& id) const { return readDemonstration(output(id + ".csv")).demonstration; }

  static std::vector<std::string> names(const Demonstration& demonstration) {
    std::vector<std::string> names;
    for (const Column& column : demonstration.columns) names.push_back(column.name);
    return names;
  }

  static std::vector<double> column(const Demonstration& demonstration, const std::string& name) {
    const std::vector<std::string> all = names(demonstration);
    const auto found = std::find(all.begin(), all.end(), name);
    EXPECT_NE(found, all.end()) << "no column " << name;
    if (found == all.end()) return {};
    const Eigen::VectorXd values = demonstration.values.col(found - all.begin());
    return {values.data(), values.data() + values.size()};
  }

  /// The joint states from number `first` on, none missing, none twice.
  static void expectCounting(const Demonstration& demonstration, double first, std::size_t count) {
    const std::vector<double> found = column(demonstration, "q_joint_1");
    ASSERT_EQ(found.size(), count);
    for (std::size_t row = 0; row < count; ++row) ASSERT_EQ(found[row], first + static_cast<double>(row));
  }

  TemporaryDirectory directory_;
  std::string namespace_;
  ros::NodeHandle node_;
  ros::Publisher joint_states_;
  ros::Subscriber status_subscriber_;
  std::vector<Status> statuses_;
  std::string diagnosis_;  // the last message seen of the task waited for
  int moved_ = 0;
  std::unique_ptr<NodeProcess> process_;

 private:
  void onStatus(const Status& status) { statuses_.push_back(status); }
};

}  // namespace demo_logger
