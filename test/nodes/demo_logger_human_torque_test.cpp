#include <demo_logger/Stop.h>
#include <geometry_msgs/WrenchStamped.h>

#include <fstream>

#include "test/nodes/recorder_under_test.h"

// The torque of the human as it happens: on a topic, and in the recording.

namespace demo_logger {
namespace {

constexpr double kHand = 2.0;      // [N m] on the shoulder
constexpr double kPeriod = 0.002;  // [s] between joint states

class HumanTorqueTest : public RecorderUnderTest {
 protected:
  void startWithRobot(const std::vector<std::string>& arguments) {
    std::ostringstream urdf;
    urdf << std::ifstream(DEMO_LOGGER_SOURCE_DIR "/urdf/two_link.urdf").rdbuf();
    ros::param::set(namespace_ + "/robot_description", urdf.str());
    observed_subscriber_ = node_.subscribe("demo_logger/human_torque", 10000, &HumanTorqueTest::onTorque, this);
    start(arguments);
  }

  /// The upright arm, at rest: gravity pulls at no joint, a hand pushes the shoulder, the motor holds against it.
  /// Stamps are exactly a period apart, however long this takes.
  void hold(int count) {
    if (stamp_.isZero()) stamp_ = ros::Time::now();
    for (int i = 0; i < count; ++i) {
      publishAt(stamp_);
      stamp_ += ros::Duration(kPeriod);
    }
  }

  /// The next joint state overtakes two others.
  void overtake() {
    for (const int place : {2, 0, 1}) publishAt(stamp_ + ros::Duration(place * kPeriod));
    stamp_ += ros::Duration(3 * kPeriod);
  }

  void setBack(double seconds) { stamp_ -= ros::Duration(seconds); }

  Demonstration finish() {
    EXPECT_TRUE(waitForRows(static_cast<std::uint64_t>(moved_)));
    const Stop::Response ended = call<Stop>("stop");
    EXPECT_TRUE(ended.success) << ended.message;
    return read(ended.id);
  }

  std::vector<sensor_msgs::JointState> observed_;

 private:
  void publishAt(const ros::Time& stamp) {
    sensor_msgs::JointState message;
    message.header.stamp = stamp;
    message.name = {"gripper", "joint_2", "joint_1"};
    message.position = {0.7, 0.0, 0.0};
    message.effort = {0.1, 0.0, -kHand};
    joint_states_.publish(message);
    ++moved_;
    ros::WallDuration(kPeriod).sleep();
    ros::spinOnce();
  }

  void onTorque(const sensor_msgs::JointState& torque) { observed_.push_back(torque); }
  ros::Subscriber observed_subscriber_;
  ros::Time stamp_;
};

TEST_F(HumanTorqueTest, StandsInEachRowAndOnATopicTheSame) {
  startWithRobot({"_tip:=tool_tip", "_human_torque:=true", "_effort/timing:=held", "_effort/control_period:=0.002"});
  hold(200);
  const Demonstration demonstration = finish();
  ASSERT_TRUE(waitUntil([&] { return observed_.size() >= 200; })) << observed_.size();
  const std::vector<double> shoulder = column(demonstration, "tau_h_joint_1");
  const std::vector<double> elbow = column(demonstration, "tau_h_joint_2");
  ASSERT_EQ(shoulder.size(), 200U);
  ASSERT_EQ(observed_.size(), 200U);
  EXPECT_EQ(observed_[0].name, (std::vector<std::string>{"joint_1", "joint_2"}));
  for (std::size_t row = 0; row < 200; ++row) {
    if (row < 51) {  // 5 / (50 1/s), behind the first velocity
      EXPECT_TRUE(std::isnan(shoulder[row])) << row;
      EXPECT_TRUE(std::isnan(observed_[row].effort[0])) << row;
      continue;
    }
    if (std::isnan(shoulder[row])) {
      EXPECT_LT(row, 53U);
      continue;
    }
    EXPECT_EQ(shoulder[row], observed_[row].effort[0]) << row;
    EXPECT_EQ(elbow[row], observed_[row].effort[1]) << row;
    const double time_running = kPeriod * static_cast<double>(row - 1);
    EXPECT_NEAR(shoulder[row], kHand * (1.0 - std::exp(-50.0 * time_running)), 1e-9) << row;
    EXPECT_NEAR(elbow[row], 0.0, 1e-9);
  }
  EXPECT_TRUE(demonstration.metadata.faults.size() <= 1) << "the gripper, at most";
  const auto& parameters = demonstration.metadata.parameters;
  EXPECT_EQ(std::get<double>(parameters.at("human_torque/gain")), 50.0);
  EXPECT_EQ(std::get<double>(parameters.at("human_torque/cutoff")), 30.0);
  EXPECT_NEAR(std::get<double>(parameters.at("human_torque/delay")), 0.0275, 1e-4);
}

TEST_F(HumanTorqueTest, AClockThatIsSetBackBeginsItAnewOnTheTopic) {
  startWithRobot({"_tip:=tool_tip", "_human_torque:=true"});
  hold(100);
  ASSERT_TRUE(waitUntil([&] { return observed_.size() == 100; })) << observed_.size();
  EXPECT_FALSE(std::isnan(observed_.back().effort[0]));
  setBack(2.0);
  hold(100);
  ASSERT_TRUE(waitUntil([&] { return observed_.size() == 199; })) << observed_.size() << "; one is no evidence";
  for (std::size_t i = 100; i < 150; ++i) EXPECT_TRUE(std::isnan(observed_[i].effort[0])) << i;
  EXPECT_NEAR(observed_.back().effort[0], kHand, 0.02);
}

TEST_F(HumanTorqueTest, JointStatesThatAreOvertakenCostNothingButThemselvesOnTheTopic) {
  startWithRobot({"_tip:=tool_tip", "_human_torque:=true"});
  hold(100);
  for (int i = 0; i < 5; ++i) {
    overtake();
    hold(10);
  }
  setBack(0.02);  // late by ten, which is no other clock either
  hold(20);
  const std::size_t expected = 100 + 5 * (1 + 10) + 10;
  ASSERT_TRUE(waitUntil([&] { return observed_.size() >= expected; })) << observed_.size();
  EXPECT_EQ(observed_.size(), expected);
  for (std::size_t i = 1; i < observed_.size(); ++i) {
    EXPECT_GT(observed_[i].header.stamp, observed_[i - 1].header.stamp) << i;
    EXPECT_TRUE(i < 60 || !std::isnan(observed_[i].effort[0])) << i;
  }
  EXPECT_NEAR(observed_.back().effort[0], kHand, 0.02);
}

TEST_F(HumanTorqueTest, ASensorsWrenchStandsBesideItAsTheTorqueItMakes) {
  XmlRpc::XmlRpcValue streams;
  streams[0]["name"] = "ft";
  streams[0]["topic"] = "wrist/wrench";
  ros::param::set(namespace_ + "/demo_logger/streams", streams);
  startWithRobot({"_human_torque/wrench:=ft", "_human_torque/observe:=false"});
  ros::Publisher sensor = node_.advertise<geometry_msgs::WrenchStamped>("wrist/wrench", 100);
  ASSERT_TRUE(waitUntil([&] { return sensor.getNumSubscribers() > 0; }));
  geometry_msgs::WrenchStamped wrench;
  wrench.header.stamp = ros::Time::now() - ros::Duration(1.0);
  wrench.header.frame_id = "tool_tip";
  wrench.wrench.force.x = 10.0;
  sensor.publish(wrench);
  ASSERT_TRUE(waitForDiagnosis("stream ft", diagnostic_msgs::DiagnosticStatus::OK, "last message"));
  hold(50);
  const Demonstration demonstration = finish();
  const std::vector<std::string> recorded = names(demonstration);
  EXPECT_EQ(std::count(recorded.begin(), recorded.end(), "tau_h_joint_1"), 0);
  for (const double torque : column(demonstration, "ft_tau_joint_1")) EXPECT_NEAR(torque, 9.0, 1e-12);
  for (const double torque : column(demonstration, "ft_tau_joint_2")) EXPECT_NEAR(torque, 4.0, 1e-12);
  EXPECT_EQ(std::get<std::string>(demonstration.metadata.parameters.at("human_torque/wrench_link")), "tool_tip");
}

TEST_F(HumanTorqueTest, StatesTooRareForItsFilterAreAFaultThatSaysWhatToDo) {
  startWithRobot({"_human_torque/cutoff:=200"});
  hold(100);  // twice as long as it takes to settle
  const Demonstration demonstration = finish();
  for (const double torque : column(demonstration, "tau_h_joint_1")) EXPECT_TRUE(std::isnan(torque));
  bool said = false;
  for (const Fault& fault : demonstration.metadata.faults) {
    said = said || fault.what.find("set human_torque/cutoff to 113.6 Hz or less") != std::string::npos;
  }
  EXPECT_TRUE(said);
}

}  // namespace
}  // namespace demo_logger
