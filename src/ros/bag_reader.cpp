#include "src/ros/bag_reader.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <fstream>
#include <map>
#include <string_view>
#include <system_error>
#include <utility>

#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/print.h"
#include "src/ros/message_conversion.h"

namespace demo_logger {
namespace {

/// What rosbag would only say in its own words, or not at all.
void requireBagFile(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw FileError(path.string() + ": no such file");
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw FileError(path.string() + ": not a file; expected a ROS bag");
  }
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (!error && size == 0) {
    throw FileError(path.string() + ": empty (0 bytes); expected a ROS bag");
  }
  constexpr std::string_view kMagic = "#ROSBAG V";
  std::string start(kMagic.size(), ' ');
  std::ifstream(path, std::ios::binary).read(start.data(), static_cast<std::streamsize>(start.size()));
  if (start != kMagic) {
    throw FileError(path.string() + ": not a ROS bag: it does not begin with \"#ROSBAG V\"");
  }
}

void openBag(rosbag::Bag& bag, const std::filesystem::path& path) {
  requireBagFile(path);
  try {
    bag.open(path.string(), rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    throw FileError(path.string() + ": has no index, as if its recording was cut off; try `rosbag reindex " +
                    path.filename().string() + "`");
  } catch (const rosbag::BagFormatException& error) {
    throw FileError(path.string() + ": damaged (" + error.what() + ")");
  } catch (const std::exception& error) {
    throw FileError(path.string() + ": cannot be read as a ROS bag, it may be cut off (" + error.what() + ")");
  }
}

}  // namespace

class BagReader::Implementation {
 public:
  explicit Implementation(std::filesystem::path path) : path_(std::move(path)) {
    openBag(bag_, path_);
    countTopics();
  }

  void read(const std::set<std::string>& topics, const std::function<void(const BagMessage&)>& visit) {
    rosbag::View view(bag_, [&](const rosbag::ConnectionInfo* connection) { return topics.count(connection->topic); });
    BagMessage message;
    std::vector<std::uint8_t> bytes;
    auto next = view.begin();
    while (next != view.end()) {
      try {
        take(*next, message, bytes);
      } catch (const std::exception& error) {
        throw FileError(path_.string() + ": damaged after " + print(toSeconds(message.arrival.receipt), 3) + " s (" +
                        error.what() + "); try `rosbag reindex`");
      }
      visit(message);
      advance(next, message);
    }
  }

  std::filesystem::path path_;
  std::vector<BagTopic> topics_;
  std::uint64_t messages_ = 0;

 private:
  /// The index holds what there is; no message is read. (A view's begin and end times are garbage when it is empty.)
  void countTopics() {
    std::map<std::string, BagTopic> topics;
    try {
      rosbag::View all(bag_);
      for (const rosbag::ConnectionInfo* connection : all.getConnections()) {
        rosbag::View one(bag_, [&](const rosbag::ConnectionInfo* other) { return other->id == connection->id; });
        BagTopic& topic = topics[connection->topic];
        topic.name = connection->topic;
        topic.type = topic.type.empty() ? connection->datatype : topic.type;
        topic.count += one.size();
      }
    } catch (const std::exception& error) {
      throw FileError(path_.string() + ": its index is damaged (" + error.what() + "); try `rosbag reindex`");
    }
    for (auto& [name, topic] : topics) {
      messages_ += topic.count;
      topics_.push_back(std::move(topic));
    }
  }

  static void take(rosbag::MessageInstance& instance, BagMessage& message, std::vector<std::uint8_t>& bytes) {
    bytes.resize(instance.size());
    ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    instance.write(stream);
    message.topic = instance.getTopic();
    message.arrival = Arrival{};
    message.arrival.receipt = toNanoseconds(instance.getTime());
    message.arrival.steady = message.arrival.receipt;
    message.arrival.publisher = instance.getCallerId();
    message.raw = {instance.getDataType(), instance.getMD5Sum(), bytes.data(),
                   static_cast<std::uint32_t>(bytes.size())};
  }

  void advance(rosbag::View::iterator& next, const BagMessage& message) {
    try {
      ++next;
    } catch (const std::exception& error) {
      throw FileError(path_.string() + ": damaged after " + print(toSeconds(message.arrival.receipt), 3) + " s (" +
                      error.what() + ")");
    }
  }

  rosbag::Bag bag_;
};

BagReader::BagReader(const std::filesystem::path& path) : implementation_(std::make_unique<Implementation>(path)) {}
BagReader::~BagReader() = default;
BagReader::BagReader(BagReader&&) noexcept = default;
BagReader& BagReader::operator=(BagReader&&) noexcept = default;

const std::filesystem::path& BagReader::path() const { return implementation_->path_; }
const std::vector<BagTopic>& BagReader::topics() const { return implementation_->topics_; }
std::uint64_t BagReader::messages() const { return implementation_->messages_; }

void BagReader::read(const std::set<std::string>& topics, const std::function<void(const BagMessage&)>& visit) const {
  implementation_->read(topics, visit);
}

std::string describeTopics(const std::vector<BagTopic>& topics) {
  std::string list;
  for (const BagTopic& topic : topics) {
    list += (list.empty() ? "" : ", ") + topic.name + " (" + topic.type + ", " + std::to_string(topic.count) + ")";
  }
  return list.empty() ? "no messages at all" : list;
}

}  // namespace demo_logger
