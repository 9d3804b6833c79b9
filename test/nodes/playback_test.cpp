#include <cstdlib>

#include "src/tool/bag_import.h"
#include "test/nodes/recorder_under_test.h"

// `rosbag play` through the live node gives the rows that `demo_tool import` makes of the same bag.

namespace demo_logger {
namespace {

class PlaybackTest : public RecorderUnderTest {
 protected:
  void SetUp() override {
    const char* data = std::getenv("DEMO_LOGGER_DATA");
    if (data == nullptr) GTEST_SKIP() << "DEMO_LOGGER_DATA is not set: no real recordings to play";
    data_ = data;
    joint_states_.shutdown();  // the player is the arm
  }

  Demonstration import(const std::string& name) const {
    const BagReader bag(data_ / name);
    ImportOptions options;
    options.output = directory_ / "imported";
    return readDemonstration(importBag(bag, planImport(bag, std::nullopt, {}), options).at(0)).demonstration;
  }

  /// Plays the bag to a node that listens, waits until it has written `rows`, and lets it save the rest.
  Demonstration record(const std::string& name, const std::string& joint_states, std::uint64_t rows,
                       const std::vector<std::string>& play_options, const std::vector<std::string>& node_options) {
    std::vector<std::string> arguments = node_options;
    arguments.push_back("joint_states:=" + joint_states);
    launch(arguments);
    EXPECT_TRUE(waitUntil([&] { return !statuses_.empty() || !process_->runs(); })) << process_->output();
    std::vector<std::string> command = {"/usr/bin/python3", "/usr/bin/rosbag", "play", "--wait-for-subscribers",
                                        "--queue",          "20000",           "-q"};
    command.insert(command.end(), play_options.begin(), play_options.end());
    command.insert(command.end(), {(data_ / name).string(), "--topics", joint_states, "/cmd_vel", "/clock"});
    NodeProcess player(command, (directory_ / "player").string());
    EXPECT_TRUE(waitUntil([&] { return !statuses_.empty() && statuses_.back().rows >= rows; }, 90.0))
        << (statuses_.empty() ? 0 : statuses_.back().rows) << " rows\n"
        << process_->output() << player.output();
    EXPECT_EQ(player.wait(), 0) << player.output();
    process_->signal(SIGINT);
    EXPECT_EQ(process_->wait(), 0) << process_->output();
    return read("demo_000001");
  }

  /// Every column of the joint states that does not depend on receipt, bit by bit; NaN equals NaN.
  static void expectSameJointRows(const Demonstration& live, const Demonstration& imported) {
    EXPECT_EQ(live.metadata.start_stamp, imported.metadata.start_stamp);
    ASSERT_EQ(live.time, imported.time);
    for (const Column& one : imported.columns) {
      const bool of_joint =
          one.name.rfind("q_", 0) == 0 || one.name.rfind("dq_", 0) == 0 || one.name.rfind("tau_", 0) == 0;
      if (!of_joint) continue;
      const std::vector<double> expected = column(imported, one.name);
      const std::vector<double> found = column(live, one.name);
      for (std::size_t row = 0; row < expected.size(); ++row) {
        const bool same = found[row] == expected[row] || (std::isnan(found[row]) && std::isnan(expected[row]));
        ASSERT_TRUE(same) << one.name << " in row " << row << ": " << found[row] << " instead of " << expected[row];
      }
    }
  }

  void expectPlaybackAtRate(const std::string& name, const std::string& joint_states, const std::string& rate) {
    const Demonstration imported = import(name);
    expectSameJointRows(record(name, joint_states, imported.time.size(), {"-r", rate}, {}), imported);
  }

  std::filesystem::path data_;
};

TEST_F(PlaybackTest, TheJitterBagAtItsOwnPace) {
  expectPlaybackAtRate("jitter_1khz_6joint.bag", "/fake_joints_state", "1");
}

TEST_F(PlaybackTest, TheJitterBagAtFourTimesItsPace) {
  expectPlaybackAtRate("jitter_1khz_6joint.bag", "/fake_joints_state", "4");
}

TEST_F(PlaybackTest, TheKukaAtFourTimesItsPace) { expectPlaybackAtRate("kuka_lwr_motion.bag", "/joint_states", "4"); }

using PlaybackAtItsOwnPaceTest = PlaybackTest;

TEST_F(PlaybackAtItsOwnPaceTest, TheKuka) { expectPlaybackAtRate("kuka_lwr_motion.bag", "/joint_states", "1"); }

TEST_F(PlaybackTest, TheNeatoInSimulatedTimeByTheClockInItsBag) {
  const Demonstration imported = import("neato_sim_teleop.bag");
  ros::param::set("/use_sim_time", true);
  const Demonstration live =
      // The bag's clock stops before the last row has waited for stragglers; it is written when the episode is saved.
      record("neato_sim_teleop.bag", "/joint_states", imported.time.size() - 1, {"-r", "4"}, {"teleop_cmd:=/cmd_vel"});
  ros::param::del("/use_sim_time");
  expectSameJointRows(live, imported);
  const std::vector<double> command = column(live, "u_vx");
  EXPECT_TRUE(std::any_of(command.begin(), command.end(), [](double value) { return value != 0.0; }));
  EXPECT_FALSE(live.metadata.streams.at(0).stamped);
  EXPECT_EQ(live.metadata.streams.at(0).received, 25U);
}

}  // namespace
}  // namespace demo_logger
