#include "demo_logger/simulation/joint_state_faults.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "demo_logger/trajectory/error.h"
#include "print.h"

namespace demo_logger {
namespace {

void require(bool holds, const std::string& field, double value, const std::string& expected) {
  if (holds && std::isfinite(value)) return;
  throw ConfigurationError("joint state faults: " + field + " is " + print(value) + ", expected " + expected + ".");
}

/// `size` of the reading's joints from `first` on.
JointReading part(const JointReading& reading, Eigen::Index first, Eigen::Index size) {
  return {reading.q.segment(first, size), reading.dq.segment(first, size), reading.effort.segment(first, size)};
}

}  // namespace

void validate(const JointStateFaultsConfiguration& c, const std::vector<std::string>& joints) {
  constexpr double kLongest = 10.0;  // [s]
  require(c.delay >= 0.0 && c.delay <= kLongest, "delay", c.delay, "from 0 to 10 s");
  require(c.jitter >= 0.0 && c.jitter <= kLongest, "jitter", c.jitter, "from 0 to 10 s");
  require(c.drop >= 0.0 && c.drop <= 1.0, "drop", c.drop, "a probability from 0 to 1");
  require(c.duplicate >= 0.0 && c.duplicate <= 1.0, "duplicate", c.duplicate, "a probability from 0 to 1");
  require(c.zero_stamp >= 0.0 && c.zero_stamp <= 1.0, "zero_stamp", c.zero_stamp, "a probability from 0 to 1");
  require(c.permute >= 0.0 && c.permute <= 1.0, "permute", c.permute, "a probability from 0 to 1");
  const int most = static_cast<int>(joints.size()) - 1;
  require(c.split >= 0 && c.split <= most, "split", c.split,
          "from 0 to " + std::to_string(most) + ", so that both messages have joints");
  std::set<std::string> arm(joints.begin(), joints.end()), gripper;
  for (const std::string& joint : c.gripper) {
    const std::string fault = joint.empty()                   ? "has a joint without a name"
                              : arm.count(joint) != 0         ? "names " + joint + ", a joint of the arm"
                              : !gripper.insert(joint).second ? "names " + joint + " twice"
                                                              : "";
    if (fault.empty()) continue;
    throw ConfigurationError("joint state faults: gripper " + fault +
                             ", expected names of joints beside the arm, once each.");
  }
}

JointStateFaults::JointStateFaults(const JointStateFaultsConfiguration& configuration, std::vector<std::string> joints)
    : configuration_(configuration), joints_(std::move(joints)), random_(configuration.seed) {
  validate(configuration_, joints_);
}

void JointStateFaults::offer(Nanoseconds stamp, const JointReading& reading) {
  const auto size = static_cast<Eigen::Index>(joints_.size());
  const auto split = static_cast<Eigen::Index>(configuration_.split);
  if (split > 0) queue({stamp, {joints_.begin(), joints_.begin() + split}, part(reading, 0, split)});
  queue({stamp, {joints_.begin() + split, joints_.end()}, part(reading, split, size - split)});
  if (configuration_.gripper.empty()) return;
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(configuration_.gripper.size()));
  queue({stamp, configuration_.gripper, {rest, rest, rest}});
}

void JointStateFaults::queue(JointStateMessage message) {
  ++counters_.messages;
  const double jitter = random_.uniform(-configuration_.jitter, configuration_.jitter);
  Nanoseconds due = message.stamp + fromSeconds(std::max(configuration_.delay + jitter, 0.0));
  if (!waiting_.empty()) due = std::max(due, waiting_.back().due);  // as a connection keeps the order
  const bool dropped = happens(configuration_.drop);
  const bool duplicated = happens(configuration_.duplicate);
  const bool zero_stamped = happens(configuration_.zero_stamp);
  const bool permuted = happens(configuration_.permute);
  permute(message, permuted);
  if (dropped) {
    ++counters_.dropped;
    return;
  }
  if (zero_stamped) {
    ++counters_.zero_stamped;
    message.stamp = 0;
  }
  if (permuted) ++counters_.permuted;
  if (duplicated) {
    ++counters_.duplicated;
    waiting_.push_back({due, message});
  }
  waiting_.push_back({due, std::move(message)});
}

/// Fisher and Yates' shuffle; drawn in any case, applied if `apply`.
void JointStateFaults::permute(JointStateMessage& message, bool apply) {
  std::vector<std::size_t> order(message.names.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = order.size(); i > 1; --i) {
    const auto other = static_cast<std::size_t>(random_.uniform(0.0, static_cast<double>(i)));
    std::swap(order[i - 1], order[other]);
  }
  if (!apply) return;
  const JointStateMessage given = message;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto to = static_cast<Eigen::Index>(i);
    const auto from = static_cast<Eigen::Index>(order[i]);
    message.names[i] = given.names[order[i]];
    message.reading.q[to] = given.reading.q[from];
    message.reading.dq[to] = given.reading.dq[from];
    message.reading.effort[to] = given.reading.effort[from];
  }
}

bool JointStateFaults::happens(double probability) { return random_.uniform(0.0, 1.0) < probability; }

std::vector<JointStateMessage> JointStateFaults::take(Nanoseconds now) {
  std::vector<JointStateMessage> due;
  while (!waiting_.empty() && waiting_.front().due <= now) {
    due.push_back(std::move(waiting_.front().message));
    waiting_.pop_front();
  }
  return due;
}

}  // namespace demo_logger
