#include "src/tool/import_plan.h"

#include <algorithm>
#include <iterator>
#include <set>

#include "demo_logger/trajectory/error.h"

namespace demo_logger {
namespace {

constexpr const char* kJointState = "sensor_msgs/JointState";

using Topics = std::vector<BagTopic>;

template <class Predicate>
Topics select(const Topics& topics, Predicate predicate) {
  Topics selected;
  std::copy_if(topics.begin(), topics.end(), std::back_inserter(selected), predicate);
  return selected;
}

std::string lastPart(const std::string& topic) { return topic.substr(topic.rfind('/') + 1); }

/// A topic by its name, with or without the leading slash.
const BagTopic& findTopic(const BagReader& bag, const std::string& name) {
  for (const BagTopic& topic : bag.topics()) {
    if (topic.name == name || topic.name == "/" + name) {
      return topic;
    }
  }
  throw FileError(bag.path().string() + ": no topic " + name + "; it holds " + describeTopics(bag.topics()));
}

std::string chooseJointStates(const BagReader& bag, const std::optional<std::string>& asked,
                              std::vector<std::string>& notes) {
  if (asked) {
    const BagTopic& topic = findTopic(bag, *asked);
    if (topic.type != kJointState) {
      throw FileError(bag.path().string() + ": " + topic.name + " is of type " + topic.type + ", expected " +
                      kJointState);
    }
    return topic.name;
  }
  const Topics candidates = select(bag.topics(), [](const BagTopic& topic) { return topic.type == kJointState; });
  for (const BagTopic& topic : candidates) {
    if (topic.name == "/joint_states") {
      return topic.name;
    }
  }
  if (candidates.empty()) {
    throw FileError(bag.path().string() + ": no joint states (" + kJointState + ") to make rows of; it holds " +
                    describeTopics(bag.topics()));
  }
  if (candidates.size() > 1) {
    throw FileError(bag.path().string() + ": several topics with joint states, " + describeTopics(candidates) +
                    "; choose one with --joint-states");
  }
  notes.push_back("joint states from " + candidates.front().name + ", the only ones in the bag");
  return candidates.front().name;
}

/// Fills in the full topic name and what kind of stream its type makes.
StreamConfiguration resolve(const BagReader& bag, StreamConfiguration stream) {
  const BagTopic& topic = findTopic(bag, stream.topic);
  const StreamConverter* converter = findStreamConverter(topic.type);
  if (converter == nullptr) {
    throw FileError(bag.path().string() + ": " + topic.name + " is of type " + topic.type +
                    ", which cannot be a stream; supported are " + supportedStreamTypes());
  }
  stream.topic = topic.name;
  stream.type = converter->type;
  return stream;
}

std::vector<StreamConfiguration> guessTeleopCommand(const BagReader& bag, std::vector<std::string>& notes) {
  for (const char* name : {"teleop_cmd", "cmd_vel"}) {
    const Topics found = select(bag.topics(), [&](const BagTopic& topic) {
      const StreamConverter* converter = findStreamConverter(topic.type);
      return lastPart(topic.name) == name && converter != nullptr && converter->type == StreamType::twist;
    });
    if (found.size() == 1) {
      notes.push_back("stream teleop_cmd from " + describeTopics(found) + ", held");
      StreamConfiguration stream;
      stream.name = "teleop_cmd";
      stream.topic = found.front().name;
      return {resolve(bag, stream)};
    }
    if (found.size() > 1) {
      notes.push_back("no command stream: " + describeTopics(found) +
                      " could each be it; choose with --stream teleop_cmd=TOPIC");
      return {};
    }
  }
  return {};
}

}  // namespace

ImportPlan planImport(const BagReader& bag, const std::optional<std::string>& joint_states,
                      const std::vector<StreamConfiguration>& streams) {
  if (bag.messages() == 0) {
    throw FileError(bag.path().string() + ": holds no messages, nothing to import");
  }
  ImportPlan plan;
  plan.joint_states = chooseJointStates(bag, joint_states, plan.notes);
  if (streams.empty()) {
    plan.streams = guessTeleopCommand(bag, plan.notes);
  }
  for (const StreamConfiguration& stream : streams) {
    plan.streams.push_back(resolve(bag, stream));
  }
  std::set<std::string> taken{plan.joint_states};
  for (const StreamConfiguration& stream : plan.streams) {
    taken.insert(stream.topic);
  }
  const Topics left = select(bag.topics(), [&](const BagTopic& topic) { return taken.count(topic.name) == 0; });
  if (!left.empty()) {
    plan.notes.push_back("left out: " + describeTopics(left));
  }
  return plan;
}

}  // namespace demo_logger
