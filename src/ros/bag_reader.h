#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "demo_logger/recording/sample.h"
#include "src/ros/stream_converter.h"

namespace demo_logger {

struct BagTopic {
  std::string name;
  std::string type;  // of its first connection
  std::uint64_t count = 0;
};

struct BagMessage {
  std::string topic;
  Arrival arrival;  // receipt: when it was recorded, on both clocks; publisher: the node that sent it
  RawMessage raw;   // valid during the visit
};

/// A ROS bag, read in the order in which it was recorded, whatever its compression and the order of its chunks. Holds
/// the bag's index and one message at a time.
class BagReader {
 public:
  /// Throws FileError: missing, empty, not a bag, cut off, not indexed.
  explicit BagReader(const std::filesystem::path& path);
  ~BagReader();
  BagReader(BagReader&&) noexcept;
  BagReader& operator=(BagReader&&) noexcept;

  const std::filesystem::path& path() const;
  const std::vector<BagTopic>& topics() const;  // by name
  std::uint64_t messages() const;

  /// Visits every message of `topics`. Throws FileError where the bag is damaged.
  void read(const std::set<std::string>& topics, const std::function<void(const BagMessage&)>& visit) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// The topics as a sentence's tail, "/cmd_vel (geometry_msgs/Twist, 25), …", or "no messages at all".
std::string describeTopics(const std::vector<BagTopic>& topics);

}  // namespace demo_logger
