#include <demo_logger/Stop.h>
#include <geometry_msgs/Twist.h>
#include <geometry_msgs/TwistStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <sensor_msgs/Joy.h>
#include <std_msgs/Float64.h>
#include <std_msgs/String.h>

#include <fstream>

#include "test/nodes/recorder_under_test.h"

// What comes in besides the joint states, and what is said where it does not.

namespace demo_logger {
namespace {

class InputsTest : public RecorderUnderTest {
 protected:
  /// A publisher that the node listens to.
  template <class Message>
  ros::Publisher connect(const std::string& topic) {
    ros::Publisher publisher = node_.advertise<Message>(topic, 1000);
    EXPECT_TRUE(waitUntil([&] { return publisher.getNumSubscribers() > 0; })) << topic;
    return publisher;
  }

  void setStream(int index, const std::string& name, const std::string& topic, const std::string& align = "hold",
                 const std::string& type = "") {
    XmlRpc::XmlRpcValue stream;
    stream["name"] = name;
    stream["topic"] = topic;
    stream["align"] = align;
    if (!type.empty()) stream["type"] = type;
    streams_[index] = stream;
    ros::param::set(namespace_ + "/demo_logger/streams", streams_);
  }

  Demonstration finish() {
    EXPECT_TRUE(waitForRows(static_cast<std::uint64_t>(moved_)));
    const Stop::Response ended = call<Stop>("stop");
    EXPECT_TRUE(ended.success) << ended.message;
    return read(ended.id);
  }

  /// `stream` was heard by the node.
  bool waitUntilHeard(const std::string& stream) {
    return waitForDiagnosis("stream " + stream, diagnostic_msgs::DiagnosticStatus::OK, "last message");
  }

 private:
  XmlRpc::XmlRpcValue streams_;
};

TEST_F(InputsTest, APlainTwistIsTheCommandFromItsReceiptOn) {
  start();
  ros::Publisher command = connect<geometry_msgs::Twist>("teleop_cmd");
  geometry_msgs::Twist twist;
  twist.linear.x = 0.25;
  twist.angular.z = -1.5;
  command.publish(twist);
  ASSERT_TRUE(waitUntilHeard("teleop_cmd"));
  move(50);
  const Demonstration demonstration = finish();
  EXPECT_EQ(column(demonstration, "u_vx"), std::vector<double>(50, 0.25)) << "in force before the first row";
  EXPECT_EQ(column(demonstration, "u_wz"), std::vector<double>(50, -1.5));
  for (const double age : column(demonstration, "u_age")) EXPECT_GT(age, 0.0);
  ASSERT_EQ(demonstration.metadata.streams.size(), 1U);
  EXPECT_FALSE(demonstration.metadata.streams[0].stamped);
}

TEST_F(InputsTest, AStampedTwistIsTheCommandFromItsStampOn) {
  start();
  ros::Publisher command = connect<geometry_msgs::TwistStamped>("teleop_cmd");
  geometry_msgs::TwistStamped twist;
  twist.header.stamp = ros::Time::now() - ros::Duration(0.5);
  twist.header.frame_id = "base_link";
  twist.twist.linear.y = 0.125;
  command.publish(twist);
  ASSERT_TRUE(waitUntilHeard("teleop_cmd"));
  move(50);
  const Demonstration demonstration = finish();
  EXPECT_EQ(column(demonstration, "u_vy"), std::vector<double>(50, 0.125));
  const std::vector<double> age = column(demonstration, "u_age");
  for (std::size_t row = 0; row < age.size(); ++row) {
    const Nanoseconds stamp = demonstration.metadata.start_stamp + fromSeconds(demonstration.time[row]);
    EXPECT_EQ(fromSeconds(age[row]), stamp - static_cast<Nanoseconds>(twist.header.stamp.toNSec())) << "row " << row;
  }
  EXPECT_TRUE(demonstration.metadata.streams.at(0).stamped);
  EXPECT_EQ(demonstration.metadata.streams.at(0).frame_id, "base_link");
}

TEST_F(InputsTest, WithoutACommandItsColumnsAreThereAndEmpty) {
  start();
  move(20);
  const Demonstration demonstration = finish();
  for (const double value : column(demonstration, "u_vx")) EXPECT_TRUE(std::isnan(value));
}

TEST_F(InputsTest, StreamsOfTheConfigurationGetTheirColumns) {
  setStream(0, "grip", "grip");
  setStream(1, "stick", "joy");
  setStream(2, "force", "ft/raw", "nearest");
  start();
  ros::Publisher grip = connect<std_msgs::Float64>("grip");
  ros::Publisher joy = connect<sensor_msgs::Joy>("joy");
  ros::Publisher force = connect<geometry_msgs::WrenchStamped>("ft/raw");
  std_msgs::Float64 width;
  width.data = 0.08;
  grip.publish(width);
  sensor_msgs::Joy stick;
  stick.header.stamp = ros::Time::now();
  stick.axes = {0.5F};
  stick.buttons = {1};
  joy.publish(stick);
  geometry_msgs::WrenchStamped wrench;
  wrench.header.stamp = ros::Time::now();
  wrench.wrench.force.z = 9.0;
  force.publish(wrench);
  for (const char* stream : {"grip", "stick", "force"}) ASSERT_TRUE(waitUntilHeard(stream));
  move(50);
  const Demonstration demonstration = finish();
  EXPECT_EQ(column(demonstration, "grip_value"), std::vector<double>(50, 0.08));
  EXPECT_EQ(column(demonstration, "stick_axis0"), std::vector<double>(50, 0.5));
  EXPECT_EQ(column(demonstration, "stick_button0"), std::vector<double>(50, 1.0));
  EXPECT_EQ(column(demonstration, "force_fz"), std::vector<double>(50, 9.0));
}

TEST_F(InputsTest, AStreamThatSaysItsTypeIsRecordedHoweverLateItComes) {
  setStream(0, "hand", "human_wrench", "hold", "wrench");
  setStream(1, "guest", "guest_wrench");
  start({"_wait_for_streams:=0.0"});
  move(50);
  ASSERT_TRUE(waitForRows(50));
  ros::Publisher hand = connect<geometry_msgs::WrenchStamped>("human_wrench");
  ros::Publisher guest = connect<geometry_msgs::WrenchStamped>("guest_wrench");
  geometry_msgs::WrenchStamped wrench;
  wrench.header.stamp = ros::Time::now();
  wrench.wrench.force.z = -4.0;
  hand.publish(wrench);
  guest.publish(wrench);
  ASSERT_TRUE(waitUntilHeard("hand"));
  move(20);
  const Demonstration demonstration = finish();
  const std::vector<double> force = column(demonstration, "hand_fz");
  ASSERT_EQ(force.size(), 70U);
  for (std::size_t row = 0; row < 50; ++row) EXPECT_TRUE(std::isnan(force[row])) << "row " << row;
  for (std::size_t row = 50; row < 70; ++row) EXPECT_EQ(force[row], -4.0) << "row " << row;
  const std::vector<std::string> all = names(demonstration);
  EXPECT_EQ(std::find(all.begin(), all.end(), "guest_fz"), all.end()) << "nobody could know its columns in time";
}

TEST_F(InputsTest, AStreamOfATypeThatCannotBeRecordedIsAnErrorInTheDiagnostics) {
  setStream(0, "chat", "chat");
  start();
  ros::Publisher chat = connect<std_msgs::String>("chat");
  chat.publish(std_msgs::String());
  EXPECT_TRUE(waitForDiagnosis("stream chat", diagnostic_msgs::DiagnosticStatus::ERROR,
                               namespace_ + "/chat: std_msgs/String: cannot be recorded as a stream; supported are "))
      << diagnosis_;
}

TEST_F(InputsTest, ATypeThatCannotBeRecordedAndIsKnownAtTheStartStopsTheNode) {
  const ros::Publisher chat = node_.advertise<std_msgs::String>("chat", 1);
  setStream(0, "chat", "chat");
  launch();
  EXPECT_EQ(process_->wait(), 1);
  EXPECT_EQ(process_->output().rfind("demo_logger: stream chat: " + namespace_ +
                                         "/chat is of type std_msgs/String, which cannot be recorded; supported are ",
                                     0),
            0U)
      << process_->output();
}

TEST_F(InputsTest, AWrongParameterStopsTheNodeWithItsFullName) {
  launch({"_max_wait:=forever"});
  EXPECT_EQ(process_->wait(), 1);
  EXPECT_EQ(process_->output(),
            "demo_logger: " + namespace_ +
                "/demo_logger/max_wait is the text \"forever\", expected a number from 0 to 10 s.\n");
  launch({"_rate:=100"});
  EXPECT_EQ(process_->wait(), 1);
  ros::param::del(namespace_ + "/demo_logger/max_wait");
  launch({"_rate:=100"});
  EXPECT_EQ(process_->wait(), 1);
  EXPECT_EQ(process_->output().rfind(
                "demo_logger: " + namespace_ + "/demo_logger/rate is not a parameter that is understood here", 0),
            0U)
      << process_->output();
  EXPECT_FALSE(std::filesystem::exists(output("")));
}

TEST_F(InputsTest, AnOutputDirectoryThatCannotBeMadeStopsTheNode) {
  launch({"_output_dir:=/proc/demos"});
  EXPECT_EQ(process_->wait(), 1);
  EXPECT_NE(process_->output().find("/proc/demos"), std::string::npos) << process_->output();
}

TEST_F(InputsTest, SilentJointStatesAreAnErrorThatNamesTheTopic) {
  startBesideTheArm({"joint_states:=/somewhere/joint_states_of_the_arm"});
  EXPECT_TRUE(waitForDiagnosis("joint states", diagnostic_msgs::DiagnosticStatus::ERROR,
                               "no JointState on /somewhere/joint_states_of_the_arm since the node began, "))
      << diagnosis_;
}

TEST_F(InputsTest, JointStatesThatFellSilentAreAnErrorThatSaysSinceWhen) {
  start();
  move(20);
  EXPECT_TRUE(waitForDiagnosis("joint states", diagnostic_msgs::DiagnosticStatus::ERROR,
                               "no JointState on " + namespace_ + "/joint_states since ROS time "))
      << diagnosis_;
}

TEST_F(InputsTest, ADistantClockWithUnstampedCommandsIsAnError) {
  start();
  ros::Publisher command = connect<geometry_msgs::Twist>("teleop_cmd");
  command.publish(geometry_msgs::Twist());
  ros::WallRate rate(200.0);
  for (int i = 0; i < 300; ++i) {
    joint_states_.publish(makeJointState(ros::Time::now() - ros::Duration(100.0)));
    rate.sleep();
  }
  EXPECT_TRUE(waitForDiagnosis("clock", diagnostic_msgs::DiagnosticStatus::ERROR,
                               "ms from this clock (transport or skew); streams without stamps cannot be placed"))
      << diagnosis_;
}

TEST_F(InputsTest, MalformedJointStatesAreCountedInTheDiagnostics) {
  start();
  move(20);
  sensor_msgs::JointState bad = makeJointState(ros::Time::now());
  bad.position.pop_back();
  joint_states_.publish(bad);
  EXPECT_TRUE(waitForDiagnosis("losses", diagnostic_msgs::DiagnosticStatus::WARN, "1 malformed_joint_states"))
      << diagnosis_;
}

TEST_F(InputsTest, TheTeleopMapInForceStandsInTheSidecar) {
  XmlRpc::XmlRpcValue map;
  map["mode"] = "rate";
  map["inputs"][0] = "axis0";
  map["outputs"][0] = "vx";
  map["gain"][0][0] = 0.5;
  map["offset"][0] = 0.1;
  map["dead_zone"] = 0.05;
  map["saturation"][0] = 0.3;
  ros::param::set(namespace_ + "/teleop_map", map);
  start();
  move(20);
  const Demonstration demonstration = finish();
  ASSERT_TRUE(demonstration.metadata.teleop_map.has_value());
  EXPECT_EQ(demonstration.metadata.teleop_map->inputs, std::vector<std::string>{"axis0"});
  EXPECT_EQ(demonstration.metadata.teleop_map->gain, std::vector<std::vector<double>>{{0.5}});
  EXPECT_EQ(demonstration.metadata.teleop_map->dead_zone, 0.05);
}

TEST_F(InputsTest, ARobotDescriptionInANamespaceAboveGivesTheToolPose) {
  std::ostringstream urdf;
  urdf << std::ifstream(DEMO_LOGGER_SOURCE_DIR "/urdf/two_link.urdf").rdbuf();
  ros::param::set(namespace_ + "/robot_description", urdf.str());
  start({"_tip:=tool_tip"});
  move(20);
  const Demonstration demonstration = finish();
  const std::vector<double> x = column(demonstration, "ee_x");
  for (std::size_t row = 0; row < x.size(); ++row) {
    const auto q1 = static_cast<double>(row);
    EXPECT_NEAR(x[row], 0.5 * std::sin(q1) + 0.4 * std::sin(q1 - 0.5), 1e-12);
  }
  EXPECT_EQ(demonstration.metadata.robot.tip, "tool_tip");
  EXPECT_EQ(demonstration.metadata.robot.joints, (std::vector<std::string>{"joint_1", "joint_2"}));
}

}  // namespace
}  // namespace demo_logger
