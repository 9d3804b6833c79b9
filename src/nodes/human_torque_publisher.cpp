#include "src/nodes/human_torque_publisher.h"

#include <algorithm>

#include "demo_logger/trajectory/not_a_number.h"
#include "src/ros/message_conversion.h"

namespace demo_logger {
namespace {

constexpr std::uint32_t kQueue = 1000;  // messages

}  // namespace

HumanTorquePublisher::HumanTorquePublisher(ros::NodeHandle private_node, const CalibratedArm& arm,
                                           const HumanTorqueObserverConfiguration& configuration)
    : observer_(arm, configuration),
      publisher_(private_node.advertise<sensor_msgs::JointState>("human_torque", kQueue)),
      q_(static_cast<Eigen::Index>(arm.robot.joints.size())),
      effort_(q_),
      torque_(q_) {
  message_.name = arm.robot.jointNames();
  message_.effort.resize(arm.robot.joints.size());
}

void HumanTorquePublisher::onJointState(const JointStateSample& sample) {
  const Nanoseconds stamp = sample.arrival.stamp != 0 ? sample.arrival.stamp : sample.arrival.receipt;
  if (!take(sample) || !isNext({stamp, sample.arrival.steady})) return;
  observer_.update(stamp, q_, effort_, torque_);
  message_.header.stamp = toRosTime(stamp);
  std::copy(torque_.begin(), torque_.end(), message_.effort.begin());
  publisher_.publish(message_);
}

/// Whether the joint state follows the last one. Messages overtake each other often, a clock is set back seldom.
bool HumanTorquePublisher::isNext(const ClockReading& reading) {
  switch (clock_.judge(reading)) {
    case ClockWatch::Verdict::on_the_line:
      if (last_ && reading.stamp <= *last_) return false;
      break;
    case ClockWatch::Verdict::jumped:
      observer_.restart();
      break;
    case ClockWatch::Verdict::suspect:
    case ClockWatch::Verdict::repeats_suspect:
      return false;
  }
  last_ = reading.stamp;
  return true;
}

/// Whether the message carries the arm.
bool HumanTorquePublisher::take(const JointStateSample& sample) {
  const std::size_t n = message_.name.size();
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t place = i;  // a driver that names no joint sends them in order
    if (!sample.names.empty()) {
      const auto found = std::find(sample.names.begin(), sample.names.end(), message_.name[i]);
      place = static_cast<std::size_t>(found - sample.names.begin());
    }
    if (place >= sample.position.size()) return false;
    const auto joint = static_cast<Eigen::Index>(i);
    q_[joint] = sample.position[place];
    effort_[joint] = place < sample.effort.size() ? sample.effort[place] : kNaN;
  }
  return true;
}

}  // namespace demo_logger
