#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "demo_logger/formats/demonstration_file.h"
#include "demo_logger/trajectory/error.h"
#include "src/ros/stream_converter.h"
#include "src/tool/bag_import.h"
#include "test/tool/temporary_directory.h"

// Recordings that others made, against truth.json, which was computed by rosbag's Python API and numpy.

namespace demo_logger {
namespace {

using nlohmann::json;

constexpr double kRelative = 1e-9;  // truth.json is printed with 12 digits
constexpr double kAbsolute = 1e-11;

class RealBagsTest : public testing::Test {
 protected:
  void SetUp() override {
    const char* data = std::getenv("DEMO_LOGGER_DATA");
    if (data == nullptr) GTEST_SKIP() << "DEMO_LOGGER_DATA is not set: no real recordings to import";
    data_ = data;
    std::ifstream(data_ / "truth.json") >> truth_;
  }

  std::vector<std::filesystem::path> import(const std::string& name) const {
    const BagReader bag(data_ / name);
    ImportOptions options;
    options.output = directory_ / name;
    return importBag(bag, planImport(bag, std::nullopt, {}), options);
  }

  Demonstration importOne(const std::string& name) const {
    const auto files = import(name);
    EXPECT_EQ(files.size(), 1U);
    return readDemonstration(files.at(0)).demonstration;
  }

  TemporaryDirectory directory_;
  std::filesystem::path data_;
  json truth_;
};

/// The values of one column.
std::vector<double> column(const Demonstration& demonstration, const std::string& name) {
  for (std::size_t i = 0; i < demonstration.columns.size(); ++i) {
    if (demonstration.columns[i].name == name) {
      const Eigen::VectorXd values = demonstration.values.col(static_cast<Eigen::Index>(i));
      return {values.data(), values.data() + values.size()};
    }
  }
  ADD_FAILURE() << "no column " << name;
  return {};
}

void expectNear(double found, double expected, const std::string& what) {
  EXPECT_NEAR(found, expected, kAbsolute + kRelative * std::abs(expected)) << what;
}

/// At `time` [s], between the rows around it.
double interpolate(const std::vector<double>& times, const std::vector<double>& values, double time) {
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  if (after == times.end()) return values.back();
  const auto i = static_cast<std::size_t>(after - times.begin());
  const double weight = (time - times[i - 1]) / (times[i] - times[i - 1]);
  return values[i - 1] + weight * (values[i] - values[i - 1]);
}

void expectStatistics(const Demonstration& demonstration, const std::string& prefix,
                      const std::vector<std::string>& joints, const json& truth) {
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const std::string name = prefix + joints[j];
    const std::vector<double> values = column(demonstration, name);
    if (truth.is_null()) {
      EXPECT_TRUE(std::all_of(values.begin(), values.end(), [](double value) { return std::isnan(value); }))
          << name << " is not in the bag: missing, never zero";
      continue;
    }
    const auto n = static_cast<double>(values.size());
    double mean = 0.0;
    for (const double value : values) mean += value / n;
    double variance = 0.0;
    for (const double value : values) variance += (value - mean) * (value - mean) / (n - 1);
    expectNear(mean, truth["mean"][j], name + " mean");
    expectNear(std::sqrt(variance), truth["std_n1"][j], name + " standard deviation");
    expectNear(*std::min_element(values.begin(), values.end()), truth["min"][j], name + " min");
    expectNear(*std::max_element(values.begin(), values.end()), truth["max"][j], name + " max");
  }
}

std::uint64_t rowsEqualToThePrevious(const Demonstration& demonstration, const std::vector<std::string>& joints) {
  std::vector<std::vector<double>> columns;
  for (const std::string& joint : joints) columns.push_back(column(demonstration, "q_" + joint));
  std::uint64_t equal = 0;
  for (std::size_t row = 1; row < demonstration.time.size(); ++row) {
    equal += std::all_of(columns.begin(), columns.end(),
                         [&](const std::vector<double>& values) { return values[row] == values[row - 1]; })
                 ? 1
                 : 0;
  }
  return equal;
}

TEST_F(RealBagsTest, EveryBagWithJointStatesBecomesWhatTheTruthSays) {
  int imported = 0;
  for (const auto& [name, bag] : truth_.items()) {
    const json topics = bag.value("topics", json::object());
    for (const auto& [topic, truth] : topics.items()) {
      if (truth["type"] != "sensor_msgs/JointState") continue;
      SCOPED_TRACE(name);
      ++imported;
      const Demonstration demonstration = importOne(name);
      const json& header = truth["header"];
      ASSERT_EQ(demonstration.time.size(), truth["count"].get<std::size_t>());
      EXPECT_EQ(demonstration.metadata.rows, truth["count"].get<std::uint64_t>());
      EXPECT_EQ(demonstration.metadata.start_stamp, header["first_ns"].get<Nanoseconds>());
      EXPECT_EQ(fromSeconds(demonstration.time.back()),
                header["last_ns"].get<Nanoseconds>() - header["first_ns"].get<Nanoseconds>());
      EXPECT_EQ(demonstration.metadata.status, "complete");

      const auto joints = truth["name_sets"][0]["names"].get<std::vector<std::string>>();
      EXPECT_EQ(demonstration.metadata.robot.joints, joints);
      expectStatistics(demonstration, "q_", joints, truth["position"]);
      expectStatistics(demonstration, "dq_", joints, truth["velocity"]);
      expectStatistics(demonstration, "tau_", joints, truth["effort"]);
      EXPECT_EQ(rowsEqualToThePrevious(demonstration, joints),
                truth["position"]["rows_equal_previous"].get<std::uint64_t>());

      const json& resampled = truth["position"]["linear_resample_100Hz"];
      const double last = (resampled["n"].get<double>() - 1) / 100.0;
      for (std::size_t j = 0; j < joints.size(); ++j) {
        const std::vector<double> values = column(demonstration, "q_" + joints[j]);
        EXPECT_NEAR(interpolate(demonstration.time, values, 0.01), resampled["row1"][j].get<double>(), 1e-9);
        EXPECT_NEAR(interpolate(demonstration.time, values, last), resampled["row_last"][j].get<double>(), 1e-9);
      }
    }
  }
  EXPECT_EQ(imported, 4) << "kuka, jitter, neato, irb1200";
}

TEST_F(RealBagsTest, EveryOtherBagIsRefusedWithTheTopicsThatExistAndNothingIsWritten) {
  int refused = 0;
  for (const auto& [name, bag] : truth_.items()) {
    if (std::filesystem::path(name).extension() != ".bag") continue;
    const json topics = bag.value("topics", json::object());
    if (std::any_of(topics.begin(), topics.end(),
                    [](const json& topic) { return topic["type"] == "sensor_msgs/JointState"; })) {
      continue;
    }
    SCOPED_TRACE(name);
    ++refused;
    try {
      import(name);
      FAIL() << "was imported";
    } catch (const FileError& error) {
      const std::string message = error.what();
      if (topics.empty()) {
        EXPECT_EQ(message, (data_ / name).string() + ": holds no messages, nothing to import");
      }
      for (const auto& [topic, truth] : topics.items()) {
        const std::string listed =
            topic + " (" + truth["type"].get<std::string>() + ", " + std::to_string(truth["count"].get<int>()) + ")";
        EXPECT_NE(message.find(listed), std::string::npos) << listed << " is not in: " << message;
      }
    }
    EXPECT_FALSE(std::filesystem::exists(directory_ / name));
  }
  EXPECT_GE(refused, 5);
}

TEST_F(RealBagsTest, TheKukaHasItsRowsItsJointsAndItsReceiptDelayAheadOfTime) {
  const Demonstration demonstration = importOne("kuka_lwr_motion.bag");
  EXPECT_EQ(demonstration.time.size(), 4101U);
  const json& delay = truth_["kuka_lwr_motion.bag"]["topics"]["/joint_states"]["header"]["record_minus_header_s"];
  std::vector<double> found = column(demonstration, "receipt_delay");
  std::sort(found.begin(), found.end());
  EXPECT_NEAR(found.front(), delay["min"].get<double>(), 1e-9);
  EXPECT_NEAR(found[found.size() / 2], delay["median"].get<double>(), 1e-9);
  EXPECT_NEAR(found.back(), delay["max"].get<double>(), 1e-9);
}

TEST_F(RealBagsTest, TheJitterBagAgreesWithAnExportThatSomeoneElseMade) {
  const Demonstration demonstration = importOne("jitter_1khz_6joint.bag");
  std::ifstream csv(data_ / "rostopic_p_fake_joints.csv");
  std::string line;
  std::getline(csv, line);
  std::vector<std::string> header;
  for (std::stringstream cells(line); std::getline(cells, line, ',');) header.push_back(line);
  const auto find = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(header.begin(), header.end(), name) - header.begin());
  };
  const std::size_t stamp = find("field.header.stamp");
  const std::size_t first = find("field.position0");
  std::size_t row = 0;
  std::size_t different = 0;
  std::vector<std::vector<double>> positions;
  for (int j = 0; j < 6; ++j) positions.push_back(column(demonstration, "q_joint_" + std::to_string(j)));
  while (std::getline(csv, line)) {
    std::vector<std::string> cells;
    for (std::stringstream rest(line); std::getline(rest, line, ',');) cells.push_back(line);
    ASSERT_LT(row, demonstration.time.size());
    EXPECT_EQ(demonstration.metadata.start_stamp + fromSeconds(demonstration.time[row]), std::stoll(cells.at(stamp)));
    for (std::size_t j = 0; j < 6; ++j) {
      different += std::abs(positions[j][row] - std::stod(cells.at(first + j))) > 1e-9 ? 1 : 0;
    }
    ++row;
  }
  EXPECT_EQ(row, 2725U);
  EXPECT_EQ(different, 2U) << "its author edited two cells by hand";
}

TEST_F(RealBagsTest, TheNeatoHoldsItsUnstampedTwistByReceiptAndSaysSo) {
  const Demonstration demonstration = importOne("neato_sim_teleop.bag");
  std::vector<std::pair<Nanoseconds, double>> commands;  // receipt, forward velocity
  const BagReader bag(data_ / "neato_sim_teleop.bag");
  bag.read({"/cmd_vel"}, [&](const BagMessage& message) {
    commands.emplace_back(message.arrival.receipt, toStreamSample(message.raw, message.arrival).values[0]);
  });
  ASSERT_EQ(commands.size(), 25U);

  const std::vector<double> velocity = column(demonstration, "u_vx");
  const std::vector<double> age = column(demonstration, "u_age");
  int commanded = 0;
  for (std::size_t row = 0; row < demonstration.time.size(); ++row) {
    const Nanoseconds stamp = demonstration.metadata.start_stamp + fromSeconds(demonstration.time[row]);
    const auto later = std::upper_bound(commands.begin(), commands.end(), stamp,
                                        [](Nanoseconds s, const auto& command) { return s < command.first; });
    if (later == commands.begin()) {
      EXPECT_TRUE(std::isnan(velocity[row]) && std::isnan(age[row])) << "no command yet in row " << row;
      continue;
    }
    ++commanded;
    EXPECT_EQ(velocity[row], std::prev(later)->second) << "row " << row;
    EXPECT_EQ(fromSeconds(age[row]), stamp - std::prev(later)->first) << "row " << row;
  }
  EXPECT_GT(commanded, 200);
  const auto& streams = demonstration.metadata.streams;
  const auto command = std::find_if(streams.begin(), streams.end(),
                                    [](const StreamMetadata& stream) { return stream.name == "teleop_cmd"; });
  ASSERT_NE(command, streams.end());
  EXPECT_FALSE(command->stamped);
  EXPECT_EQ(command->received, 25U);
  EXPECT_EQ(command->topic, "/cmd_vel");
  EXPECT_EQ(command->type, "geometry_msgs/Twist");
}

}  // namespace
}  // namespace demo_logger
