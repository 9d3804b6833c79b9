#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <functional>
#include <string>
#include <vector>

namespace demo_logger {

/// Bound on everything that must happen; generous, as machines that test are busy.
constexpr double kPatience = 30.0;  // [s]

/// Handles messages until `holds`; false if it does not within the patience.
inline bool waitFor(const std::function<bool()>& holds, double patience = kPatience) {
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(patience);
  while (!holds()) {
    if (ros::WallTime::now() > end || !ros::ok()) return false;
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
  }
  return true;
}

/// Keeps every message of a topic.
template <typename Message>
class Listener {
 public:
  Listener(ros::NodeHandle node, const std::string& topic) {
    subscriber_ = node.subscribe<Message>(topic, 0,
                                          boost::function<void(const boost::shared_ptr<Message const>&)>(
                                              [this](const auto& message) { messages_.push_back(*message); }));
  }

  const std::vector<Message>& messages() const { return messages_; }
  const Message& last() const { return messages_.back(); }
  void forget() { messages_.clear(); }
  std::uint32_t publishers() const { return subscriber_.getNumPublishers(); }

  /// Waits for `count` messages from now on.
  bool wait(std::size_t count = 1) {
    const std::size_t goal = messages_.size() + count;
    return waitFor([&] { return messages_.size() >= goal; });
  }
  /// Waits for a message from now on that satisfies `holds`.
  bool waitUntil(const std::function<bool(const Message&)>& holds) {
    std::size_t next = messages_.size();
    return waitFor([&] {
      for (; next < messages_.size(); ++next) {
        if (holds(messages_[next])) return true;
      }
      return false;
    });
  }

 private:
  ros::Subscriber subscriber_;
  std::vector<Message> messages_;
};

}  // namespace demo_logger
