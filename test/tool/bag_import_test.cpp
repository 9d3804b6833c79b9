#include "src/tool/bag_import.h"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Float64.h>

#include <fstream>

#include "demo_logger/formats/demonstration_file.h"
#include "demo_logger/trajectory/error.h"
#include "test/tool/temporary_directory.h"

namespace demo_logger {
namespace {

sensor_msgs::JointState makeJointState(const ros::Time& stamp, double position) {
  sensor_msgs::JointState message;
  message.header.stamp = stamp;
  message.name = {"joint_1", "joint_2"};
  message.position = {position, -position};
  return message;
}

class BagImportTest : public testing::Test {
 protected:
  /// Joint states at 100 Hz from `begin` [s] on, received 1 ms after their stamp.
  static void writeMotion(rosbag::Bag& bag, double begin, int count) {
    for (int i = 0; i < count; ++i) {
      const ros::Time stamp(begin + 0.01 * i);
      bag.write("/joint_states", stamp + ros::Duration(0.001), makeJointState(stamp, 0.001 * i));
    }
  }

  std::vector<std::filesystem::path> import(const std::filesystem::path& path) {
    const BagReader bag(path);
    return importBag(bag, planImport(bag, std::nullopt, {}), options_);
  }

  BagImportTest() { options_.output = directory_ / "demos"; }

  TemporaryDirectory directory_;
  ImportOptions options_;
};

TEST_F(BagImportTest, ALongerPauseThanTheSplitGapBeginsAnotherEpisode) {
  const auto path = directory_ / "two.bag";
  {
    rosbag::Bag bag(path.string(), rosbag::bagmode::Write);
    writeMotion(bag, 100.0, 50);
    writeMotion(bag, 110.0, 30);
  }
  options_.split_gap = 2.0;
  const auto files = import(path);
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(readDemonstration(files[0]).demonstration.time.size(), 50U);
  EXPECT_EQ(readDemonstration(files[1]).demonstration.time.size(), 30U);
}

TEST_F(BagImportTest, WithoutASplitGapItIsOneEpisodeAndTheNextImportGetsTheNextNumber) {
  const auto path = directory_ / "two.bag";
  {
    rosbag::Bag bag(path.string(), rosbag::bagmode::Write);
    writeMotion(bag, 100.0, 50);
    writeMotion(bag, 100.6, 30);
  }
  const auto first = import(path);
  const auto second = import(path);
  ASSERT_EQ(first.size(), 1U);
  ASSERT_EQ(second.size(), 1U);
  EXPECT_EQ(first[0].filename(), "demo_000001.csv");
  EXPECT_EQ(second[0].filename(), "demo_000002.csv");
  EXPECT_EQ(readDemonstration(first[0]).demonstration.time.size(), 80U);
}

TEST_F(BagImportTest, TheToolPoseIsAddedWhereARobotIsGiven) {
  const auto path = directory_ / "motion.bag";
  {
    rosbag::Bag bag(path.string(), rosbag::bagmode::Write);
    writeMotion(bag, 100.0, 50);
  }
  options_.robot = describeRobotFile(DEMO_LOGGER_SOURCE_DIR "/urdf/two_link.urdf", {"base_link", "tool_tip", {}, 9.81});
  const Demonstration demonstration = readDemonstration(import(path).at(0)).demonstration;
  std::vector<std::string> names;
  for (const Column& column : demonstration.columns) names.push_back(column.name);
  const auto x = std::find(names.begin(), names.end(), "ee_x");
  ASSERT_NE(x, names.end());
  const double q = 0.049;  // of the last row; link 2 stays upright
  EXPECT_NEAR(demonstration.values(49, x - names.begin()), 0.5 * std::sin(q), 1e-12);
  EXPECT_EQ(demonstration.metadata.robot.tip, "tool_tip");
  EXPECT_EQ(demonstration.metadata.robot.name, "two_link");
  EXPECT_EQ(demonstration.metadata.robot.urdf_sha256.size(), 64U);
}

TEST_F(BagImportTest, WhereItCameFromStandsInTheSidecar) {
  const auto path = directory_ / "motion.bag";
  {
    rosbag::Bag bag(path.string(), rosbag::bagmode::Write);
    writeMotion(bag, 100.0, 50);
  }
  options_.channel = "kinesthetic";
  const Metadata metadata = readDemonstration(import(path).at(0)).demonstration.metadata;
  EXPECT_EQ(metadata.channel, "kinesthetic");
  EXPECT_EQ(metadata.provenance.parent, "motion.bag");
  EXPECT_EQ(std::get<std::string>(metadata.parameters.at("joint_states")), "/joint_states");
  EXPECT_EQ(metadata.software.rfind("demo_logger ", 0), 0U);
}

TEST_F(BagImportTest, NothingRemainsOfABagThatIsDamagedInTheMiddle) {
  const auto path = directory_ / "damaged.bag";
  {
    rosbag::Bag bag(path.string(), rosbag::bagmode::Write);
    bag.setCompression(rosbag::CompressionType::BZ2);
    bag.setChunkThreshold(8192);
    writeMotion(bag, 100.0, 2000);
  }
  {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(std::filesystem::file_size(path) / 2));
    file << std::string(200, '\xff');
  }
  EXPECT_THROW(import(path), FileError);
  EXPECT_FALSE(std::filesystem::exists(options_.output));
}

TEST_F(BagImportTest, JointStatesThatCannotMakeARowAreSaidAndNothingIsWritten) {
  const auto path = directory_ / "malformed.bag";
  {
    rosbag::Bag bag(path.string(), rosbag::bagmode::Write);
    sensor_msgs::JointState message = makeJointState(ros::Time(100.0), 0.0);
    message.position.pop_back();  // one position for two names
    for (int i = 0; i < 10; ++i) bag.write("/joint_states", ros::Time(100.0 + i), message);
  }
  try {
    import(path);
    FAIL() << "was imported";
  } catch (const FileError& error) {
    EXPECT_EQ(std::string(error.what()), path.string() +
                                             ": none of the joint states on /joint_states could make a row; `rostopic "
                                             "echo -b` shows what they hold");
  }
  EXPECT_FALSE(std::filesystem::exists(options_.output));
}

}  // namespace
}  // namespace demo_logger
