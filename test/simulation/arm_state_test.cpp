// Saved states, and the same bits wherever the same arm runs.

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "demo_logger/simulation/simulated_arm.h"
#include "demo_logger/trajectory/error.h"
#include "test/simulation/arms.h"

namespace demo_logger {
namespace {

constexpr Nanoseconds kStart = 5 * kNanosecondsPerSecond;

/// Everything that has a memory: noise, differenced velocities, a floor and a box to lean on, stiction.
SimulatedArmConfiguration everything(ControlMode mode) {
  SimulatedArmConfiguration configuration = makeArmConfiguration(mode);
  configuration.sensors.position_noise = 1e-4;
  configuration.sensors.position_resolution = 2.4e-5;
  configuration.sensors.effort_noise = 0.01;
  configuration.sensors.velocity_from_positions = true;
  configuration.sensors.velocity_cutoff = 30.0;
  configuration.sensors.effort_side = EffortSide::link;
  configuration.surroundings.floor = 0.0;
  CollisionShape box;
  box.size = {0.4, 0.4, 0.3};
  box.pose.translation() = Eigen::Vector3d(0.6, 0.0, 0.15);
  configuration.surroundings.obstacles = {box};
  return configuration;
}

ArmCommand makeCommand(ControlMode mode, int k) {
  ArmCommand command;
  command.mode = mode;
  command.source = "/tester";
  command.stamp = kStart + k * kMillisecond - 3 * kMillisecond;
  if (mode == ControlMode::cartesian_velocity) {
    command.values = Eigen::VectorXd::Zero(6);
    command.values[2] = k < 1500 ? -0.3 : 0.1 * std::sin(0.01 * k);  // down onto the box
    command.values[5] = 0.2 * std::cos(0.003 * k);
  } else if (mode == ControlMode::trajectory) {
    const std::vector<double> bent = bentPosition();
    const Eigen::VectorXd q = Eigen::Map<const Eigen::VectorXd>(bent.data(), 7);
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(7);
    command.path = {{2.0, q + Eigen::VectorXd::Constant(7, 0.4), none, none}, {4.0, q, none, none}};
    command.stamp = 0;
  } else {
    command.values = Eigen::VectorXd::Constant(7, 0.2 * std::sin(0.004 * k));
  }
  return command;
}

ArmTick tickAt(SimulatedArm& arm, ControlMode mode, int k, Nanoseconds shift = 0) {
  std::vector<ArmCommand> commands;
  bool due = mode == ControlMode::trajectory ? k == 10 : k % 20 == 0 && k < 2400;  // in the end it times out
  if (isCompliant(mode)) due = false;
  if (due) commands.push_back(makeCommand(mode, k));
  if (!commands.empty() && commands[0].stamp != 0) commands[0].stamp += shift;
  if (k == 300) arm.setLoad(BodyInertia{0.7, {0.0, 0.01, 0.05}, Eigen::Matrix3d::Identity() * 1e-3});
  if (k == 900)
    arm.applyWrench({5, {0.0, 0.0, 0.1}, {3.0, 8.0, 0.0}, {0.0, 0.0, 0.0}, true}, kStart + shift + 1700 * kMillisecond);
  return arm.tick(kStart + shift + k * kMillisecond, commands);
}

void expectSame(const ArmTick& a, const ArmTick& b, int k) {
  ASSERT_EQ(a.index, b.index) << "tick " << k;
  ASSERT_EQ(a.truth.q, b.truth.q) << "tick " << k;
  ASSERT_EQ(a.truth.dq, b.truth.dq) << "tick " << k;
  ASSERT_EQ(a.reading.q, b.reading.q) << "tick " << k;
  ASSERT_EQ(a.reading.dq, b.reading.dq) << "tick " << k;
  ASSERT_EQ(a.reading.effort, b.reading.effort) << "tick " << k;
  ASSERT_EQ(a.external_torque, b.external_torque) << "tick " << k;
  ASSERT_EQ(a.applied.torque, b.applied.torque) << "tick " << k;
  ASSERT_EQ(a.applied.command, b.applied.command) << "tick " << k;
  ASSERT_EQ(a.applied.reason, b.applied.reason) << "tick " << k;
}

class ArmStateTest : public testing::TestWithParam<ControlMode> {};

TEST_P(ArmStateTest, AFreshArmGoesOnFromASavedStateBitByBit) {
  const ControlMode mode = GetParam();
  SimulatedArm arm(describeDemoArm(), everything(mode));
  constexpr int kSaved = 1200;
  for (int k = 0; k < kSaved; ++k) tickAt(arm, mode, k);
  const std::string state = arm.saveState();
  const bool touching = !arm.contacts().empty();
  SimulatedArm restored(describeDemoArm(), everything(mode));
  for (int k = 0; k < 7; ++k) tickAt(restored, mode, k);  // what was before does not matter
  restored.restoreState(state);
  EXPECT_EQ(restored.saveState(), state);
  EXPECT_EQ(restored.nextTick(), kStart + kSaved * kMillisecond);
  for (int k = kSaved; k < 3500; ++k) {
    expectSame(tickAt(arm, mode, k), tickAt(restored, mode, k), k);
    if (HasFatalFailure()) return;
  }
  EXPECT_TRUE(touching || mode != ControlMode::cartesian_velocity) << "it was to be saved while it leans on the box";
}

TEST_P(ArmStateTest, AlsoOnAClockThatShowsAnotherTime) {
  const ControlMode mode = GetParam();
  SimulatedArm arm(describeDemoArm(), everything(mode));
  constexpr int kSaved = 1200;
  for (int k = 0; k < kSaved; ++k) tickAt(arm, mode, k);
  const Nanoseconds shift = 1'700'000'000 * kNanosecondsPerSecond;
  SimulatedArm restored(describeDemoArm(), everything(mode));
  restored.restoreState(arm.saveState(), kStart + kSaved * kMillisecond + shift);
  for (int k = kSaved; k < 3500; ++k) {
    expectSame(tickAt(arm, mode, k), tickAt(restored, mode, k, shift), k);
    if (HasFatalFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(Modes, ArmStateTest,
                         testing::Values(ControlMode::velocity, ControlMode::trajectory,
                                         ControlMode::cartesian_velocity, ControlMode::gravity_compensation,
                                         ControlMode::impedance),
                         [](const auto& test) { return toString(test.param); });

TEST(ArmStateFileTest, AlsoFromTheMiddleOfATakeOverByAnotherMode) {
  const auto push = [](SimulatedArm& arm, int k) {
    if (k == 5) arm.applyWrench({6, {0.0, 0.0, 0.2}, {0.0, 9.0, 5.0}, {}, false}, kStart + 400 * kMillisecond);
    if (k == 100)
      arm.setMode(ControlMode::impedance, {Eigen::VectorXd::Constant(7, 30.0), Eigen::VectorXd::Ones(7) * 0.3});
    if (k == 300) arm.setMode(ControlMode::gravity_compensation);
    return arm.tick(kStart + k * kMillisecond, {});
  };
  for (const int saved : {99, 100, 101, 150, 299, 300, 350}) {
    SimulatedArm arm(describeDemoArm(), everything(ControlMode::gravity_compensation));
    SimulatedArm restored(describeDemoArm(), everything(ControlMode::velocity));
    for (int k = 0; k < saved; ++k) push(arm, k);
    restored.restoreState(arm.saveState());
    for (int k = saved; k < 600; ++k) {
      expectSame(push(arm, k), push(restored, k), k);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(ArmStateFileTest, WhatIsNoStateOfThisArmIsRefusedInASentence) {
  SimulatedArm arm(describeDemoArm(), makeArmConfiguration(ControlMode::velocity));
  const auto messageOf = [&](const std::string& json) -> std::string {
    try {
      arm.restoreState(json);
    } catch (const ConfigurationError& error) {
      return error.what();
    }
    return "taken";
  };
  EXPECT_EQ(messageOf("{\"format\": 3}"),
            "state of a simulated arm: \"format\" is of another type than expected. Was it saved by this version, with "
            "this configuration?");
  EXPECT_EQ(messageOf("{}"),
            "state of a simulated arm: \"format\" is missing. Was it saved by this version, with this configuration?");
  EXPECT_EQ(messageOf("no json").rfind("state of a simulated arm: not JSON: ", 0), 0U);
  std::string other = arm.saveState();
  other.replace(other.find("\"demo_arm\""), 10, "\"his_arm\"");
  EXPECT_EQ(messageOf(other),
            "state of a simulated arm: \"robot\" is \"his_arm\", expected \"demo_arm\", that of this arm.");
  EXPECT_EQ(messageOf(arm.saveState()), "taken");
}

TEST(ArmStateFileTest, WhatNoArmCouldHaveSavedIsRefusedInASentence) {
  using Json = nlohmann::ordered_json;
  SimulatedArm arm(describeDemoArm(), everything(ControlMode::trajectory));
  for (int k = 0; k < 1000; ++k) tickAt(arm, ControlMode::trajectory, k);
  const Json sound = Json::parse(arm.saveState());
  const auto messageOf = [&](const std::string& field, const Json& value, std::optional<Nanoseconds> next = {}) {
    Json state = sound;
    state[Json::json_pointer(field)] = value;
    SimulatedArm restored(describeDemoArm(), everything(ControlMode::trajectory));
    try {
      restored.restoreState(state.dump(), next);
    } catch (const ConfigurationError& error) {
      return std::string(error.what());
    }
    restored.tick(restored.nextTick(), {});
    return std::string("taken");
  };
  const auto sentence = [](const std::string& what) {
    return "state of a simulated arm: " + what + ". Was it saved by this version, with this configuration?";
  };
  EXPECT_EQ(messageOf("/ticks", 7), "taken");
  for (const Json& ticks : {Json(-1), Json(1.5), Json(1ULL << 60U)}) {
    EXPECT_EQ(messageOf("/ticks", ticks),
              sentence("\"ticks\" is " + ticks.dump() + ", expected a whole number from 0 to 9007199254740992"));
  }
  for (const std::optional<Nanoseconds> next : {std::optional<Nanoseconds>(), std::optional<Nanoseconds>(kStart)}) {
    for (const Json& stamp : {Json(-5), Json(1e300), Json(9'000'000'000'000'000'000), Json("soon")}) {
      EXPECT_EQ(
          messageOf("/next_tick", stamp, next),
          sentence("\"next_tick\" is " + stamp.dump() + ", expected a whole number from 0 to 4000000000000000000 ns"));
    }
  }
  EXPECT_EQ(messageOf("/wrenches", 1'000'000'000),
            sentence("\"wrenches\" is 1000000000, expected a whole number from 0 to 32"));
  EXPECT_EQ(messageOf("/wrench_0/joint", 7), sentence("\"joint\" of a wrench is 7, none of this arm"));
  EXPECT_EQ(messageOf("/wrench_0/force", Json::array({1.0, 2.0})), sentence("\"force\" has 2 numbers, expected 3"));
  EXPECT_EQ(messageOf("/wrench_0/force", Json::array({1e6, 2.0, 0.0})),
            "state of a simulated arm: the wrench has a component of 1e+06 N or N m, expected at most 10000.");
  for (const std::string& text : {std::string(), std::string("1 2 3"), std::string(1'000'000, '1')}) {
    EXPECT_EQ(messageOf("/sensors/generator", text),
              sentence("\"generator\" of " + std::to_string(text.size()) +
                       " characters is not the text of a std::mt19937_64, which is 312 numbers and one"));
  }
  EXPECT_EQ(messageOf("/body/link_torque", Json::array({1.0})), sentence("\"link_torque\" has 1 numbers, expected 7"));
  EXPECT_EQ(messageOf("/body/link_torque", Json::array({0, 0, 0, 1e300, 0, 0, 0})),
            sentence("\"link_torque\" holds 1e+300, expected at most 1e+09 either way, as arms do"));
  EXPECT_EQ(messageOf("/body/q", Json::array({0, 0, 0, 99, 0, 0, 0})),
            "state of a simulated arm: simulated robot 'demo_arm': joint 'joint_4' cannot start at 99 rad, expected a "
            "position from -2.0944 to 2.0944");
  EXPECT_EQ(messageOf("/controller/reference/velocity", Json::array()),
            sentence("\"velocity\" has 0 numbers, expected 7"));
  EXPECT_EQ(messageOf("/controller/mode", "velocity"),
            sentence("\"gate\" holds a command for another mode than velocity"));
  EXPECT_EQ(messageOf("/controller/path/active/points/1/time", 0.0),
            sentence("\"points\" are no path, expected at least one, and times that increase"));
  EXPECT_EQ(messageOf("/controller/path/active/points/size", 1e9),
            sentence("\"size\" is 1000000000.0, expected a whole number from 0 to 20000"));
}

/// Everything that a run decides, mixed into one number.
std::size_t fingerprint() {
  std::size_t hash = 0;
  const auto mix = [&](const Eigen::VectorXd& values) {
    for (const double value : values) hash = hash * 1'099'511'628'211U + std::hash<double>()(value);
  };
  for (const ControlMode mode : {ControlMode::velocity, ControlMode::trajectory, ControlMode::cartesian_velocity}) {
    SimulatedArm arm(describeDemoArm(), everything(mode));
    for (int k = 0; k < 2000; ++k) {
      const ArmTick tick = tickAt(arm, mode, k);
      mix(tick.truth.q);
      mix(tick.reading.effort);
      mix(tick.applied.torque);
    }
  }
  return hash;
}

constexpr const char* kAskedFor = "DEMO_LOGGER_PRINT_FINGERPRINT";

TEST(ArmProcessTest, PrintsItsFingerprint) {
  if (std::getenv(kAskedFor) == nullptr) GTEST_SKIP() << "only when another process asks for it";
  std::printf("fingerprint %zu\n", fingerprint());
}

TEST(ArmProcessTest, AnotherProcessComesToTheSameBits) {
  std::array<char, 4096> program{};
  ASSERT_GT(readlink("/proc/self/exe", program.data(), program.size() - 1), 0);
  const std::string command = std::string(kAskedFor) + "=1 '" + program.data() +
                              "' --gtest_output= --gtest_filter=ArmProcessTest.PrintsItsFingerprint";
  const std::unique_ptr<FILE, int (*)(FILE*)> output(popen(command.c_str(), "r"), pclose);
  ASSERT_TRUE(output);
  std::size_t theirs = 0;
  std::array<char, 256> line{};
  while (std::fgets(line.data(), line.size(), output.get()) != nullptr) {
    std::sscanf(line.data(), "fingerprint %zu", &theirs);
  }
  EXPECT_NE(theirs, 0U);
  EXPECT_EQ(theirs, fingerprint());
}

}  // namespace
}  // namespace demo_logger
