#include "src/ros/bag_reader.h"

#include <geometry_msgs/Twist.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <std_msgs/Float64.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "demo_logger/trajectory/error.h"
#include "src/ros/message_conversion.h"

namespace demo_logger {
namespace {

namespace fs = std::filesystem;

class BagReaderTest : public testing::Test {
 protected:
  BagReaderTest() {
    std::string pattern = (fs::temp_directory_path() / "bag_reader_XXXXXX").string();
    directory_ = mkdtemp(pattern.data());
  }
  ~BagReaderTest() override { fs::remove_all(directory_); }

  fs::path file(const std::string& name) const { return directory_ / name; }

  static std_msgs::Float64 number(double value) {
    std_msgs::Float64 message;
    message.data = value;
    return message;
  }

  /// `count` numbers on /number, 1 ms apart, from two nodes in turn.
  fs::path writeNumbers(const std::string& name, int count, rosbag::CompressionType compression) const {
    rosbag::Bag bag(file(name).string(), rosbag::bagmode::Write);
    bag.setCompression(compression);
    bag.setChunkThreshold(4096);
    for (int i = 0; i < count; ++i) {
      auto header = boost::make_shared<ros::M_string>();
      (*header)["callerid"] = i % 2 == 0 ? "/even" : "/odd";
      (*header)["type"] = "std_msgs/Float64";
      (*header)["md5sum"] = ros::message_traits::md5sum<std_msgs::Float64>();
      (*header)["message_definition"] = ros::message_traits::definition<std_msgs::Float64>();
      bag.write("/number", toRosTime(1'000'000'000 + i * 1'000'000L), number(i), header);
    }
    bag.close();
    return file(name);
  }

  static std::vector<double> readNumbers(const BagReader& bag) {
    std::vector<double> values;
    bag.read({"/number"}, [&](const BagMessage& message) {
      values.push_back(toStreamSample(message.raw, message.arrival).values.at(0));
    });
    return values;
  }

  static std::string messageOf(const fs::path& path) {
    try {
      const BagReader bag(path);
      readNumbers(bag);
    } catch (const FileError& error) {
      return error.what();
    }
    return "nothing was thrown";
  }

  fs::path directory_;
};

TEST_F(BagReaderTest, EveryCompressionGivesTheSameMessages) {
  constexpr int kCount = 2000;
  std::vector<double> expected(kCount);
  for (int i = 0; i < kCount; ++i) expected[static_cast<std::size_t>(i)] = i;
  for (const auto compression :
       {rosbag::CompressionType::Uncompressed, rosbag::CompressionType::BZ2, rosbag::CompressionType::LZ4}) {
    const BagReader bag(writeNumbers("numbers" + std::to_string(compression) + ".bag", kCount, compression));
    EXPECT_EQ(bag.messages(), static_cast<std::uint64_t>(kCount));
    EXPECT_EQ(readNumbers(bag), expected);
  }
}

TEST_F(BagReaderTest, AMessageCarriesWhenItWasRecordedAndWhoSentIt) {
  const BagReader bag(writeNumbers("numbers.bag", 4, rosbag::CompressionType::Uncompressed));
  std::vector<std::string> publishers;
  std::vector<Nanoseconds> receipts;
  bag.read({"/number"}, [&](const BagMessage& message) {
    publishers.push_back(message.arrival.publisher);
    receipts.push_back(message.arrival.receipt);
    EXPECT_EQ(message.arrival.steady, message.arrival.receipt);
    EXPECT_EQ(message.topic, "/number");
  });
  EXPECT_EQ(publishers, (std::vector<std::string>{"/even", "/odd", "/even", "/odd"}));
  EXPECT_EQ(receipts, (std::vector<Nanoseconds>{1'000'000'000, 1'001'000'000, 1'002'000'000, 1'003'000'000}));
}

TEST_F(BagReaderTest, MessagesWrittenOutOfOrderAreReadInTheOrderOfTheirReceipt) {
  {
    rosbag::Bag bag(file("late.bag").string(), rosbag::bagmode::Write);
    bag.setChunkThreshold(1);  // each message in a chunk of its own
    for (const int second : {3, 1, 2}) bag.write("/number", ros::Time(second, 0), number(second));
  }
  EXPECT_EQ(readNumbers(BagReader(file("late.bag"))), (std::vector<double>{1, 2, 3}));
}

TEST_F(BagReaderTest, TopicsAreListedWithTypeAndCountWithoutReadingThem) {
  {
    rosbag::Bag bag(file("two.bag").string(), rosbag::bagmode::Write);
    bag.write("/cmd_vel", ros::Time(1, 0), geometry_msgs::Twist());
    bag.write("/b", ros::Time(2, 0), number(1));
    bag.write("/b", ros::Time(3, 0), number(1));
  }
  const BagReader bag(file("two.bag"));
  EXPECT_EQ(describeTopics(bag.topics()), "/b (std_msgs/Float64, 2), /cmd_vel (geometry_msgs/Twist, 1)");
  EXPECT_EQ(describeTopics({}), "no messages at all");
}

TEST_F(BagReaderTest, ABagWithoutMessagesIsReadWithoutVisitingAny) {
  { const rosbag::Bag bag(file("none.bag").string(), rosbag::bagmode::Write); }
  const BagReader bag(file("none.bag"));
  EXPECT_EQ(bag.messages(), 0U);
  EXPECT_TRUE(bag.topics().empty());
  EXPECT_TRUE(readNumbers(bag).empty());
}

TEST_F(BagReaderTest, WhatIsNotABagIsRefusedInOneSentence) {
  EXPECT_EQ(messageOf(file("gone.bag")), file("gone.bag").string() + ": no such file");
  EXPECT_EQ(messageOf(directory_), directory_.string() + ": not a file; expected a ROS bag");

  std::ofstream(file("empty.bag")).close();
  EXPECT_EQ(messageOf(file("empty.bag")), file("empty.bag").string() + ": empty (0 bytes); expected a ROS bag");

  std::ofstream(file("text.bag")) << "time,q_elbow\n0,1\n";
  EXPECT_EQ(messageOf(file("text.bag")).rfind(file("text.bag").string() + ": not a ROS bag", 0), 0U)
      << messageOf(file("text.bag"));
}

TEST_F(BagReaderTest, ABagCutOffAnywhereIsRefusedAndNeverCrashes) {
  const fs::path whole = writeNumbers("whole.bag", 500, rosbag::CompressionType::BZ2);
  const auto size = fs::file_size(whole);
  const fs::path cut = file("cut.bag");
  for (std::uintmax_t length = 1; length < size; length += 97) {
    fs::copy_file(whole, cut, fs::copy_options::overwrite_existing);
    fs::resize_file(cut, length);
    const std::string message = messageOf(cut);
    ASSERT_EQ(message.rfind(cut.string() + ": ", 0), 0U) << "cut to " << length << " bytes: " << message;
    ASSERT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST_F(BagReaderTest, ARecordingThatWasKilledIsToldToReindex) {
  const fs::path cut = file("killed.bag");
  {
    rosbag::Bag bag(cut.string(), rosbag::bagmode::Write);
    for (int i = 0; i < 3; ++i) bag.write("/number", ros::Time(i + 1, 0), number(i));
    fs::copy_file(cut, file("copy.bag"));  // as the recorder leaves it when it dies: the index position is still 0
  }
  fs::resize_file(file("copy.bag"), 5000);
  EXPECT_EQ(messageOf(file("copy.bag")), file("copy.bag").string() +
                                             ": has no index, as if its recording was cut off; try `rosbag reindex "
                                             "copy.bag`");
}

TEST(RealBagsTest, UnsortedChunksComeOutInOrder) {
  const char* data = std::getenv("DEMO_LOGGER_DATA");
  if (data == nullptr) GTEST_SKIP() << "DEMO_LOGGER_DATA is not set: no real recordings to read";
  const BagReader bag(fs::path(data) / "unsorted_chunks.bag");
  std::vector<Nanoseconds> receipts;
  std::set<std::string> names;
  for (const BagTopic& topic : bag.topics()) names.insert(topic.name);
  bag.read(names, [&](const BagMessage& message) { receipts.push_back(message.arrival.receipt); });
  EXPECT_EQ(receipts.size(), 3U);
  EXPECT_TRUE(std::is_sorted(receipts.begin(), receipts.end()));
}

}  // namespace
}  // namespace demo_logger
