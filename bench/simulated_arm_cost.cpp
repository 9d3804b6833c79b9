// What one simulated millisecond costs: physics, friction, control and sensors of an arm at work, in CPU time.
// Prints a table in Markdown.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "demo_logger/simulation/simulated_arm.h"

namespace demo_logger {
namespace {

constexpr Nanoseconds kMillisecond = 1'000'000;
constexpr int kTicksPerBatch = 2000;
constexpr int kBatches = 15;

double processTime() { return 1e6 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }  // [µs]

struct Cost {
  double median = 0.0;  // [µs per call]
  double best = 0.0;
};

/// Batches, so that what else the machine does shows as the difference of the median to the best.
Cost measure(const std::function<void()>& call) {
  std::vector<double> batches;
  for (int batch = 0; batch < kBatches; ++batch) {
    const double start = processTime();
    for (int k = 0; k < kTicksPerBatch; ++k) call();
    batches.push_back((processTime() - start) / kTicksPerBatch);
  }
  std::sort(batches.begin(), batches.end());
  return {batches[kBatches / 2], batches.front()};
}

void printRow(const std::string& what, const Cost& cost) {
  std::printf("| %s | %.1f | %.1f | %.0f |\n", what.c_str(), cost.median, cost.best, 1000.0 / cost.median);
  std::fflush(stdout);
}

RobotDescription describeDemoArm() {
  DescriptionOptions options;
  options.base = "base_link";
  options.tip = "tool_tip";
  return describeRobotFile(std::string(DEMO_LOGGER_SOURCE_DIR) + "/urdf/demo_arm.urdf", options);
}

SimulatedArmConfiguration atWork(ControlMode mode) {
  SimulatedArmConfiguration configuration;
  configuration.mode = mode;
  configuration.initial_position = {0.0, 0.3, 0.0, 1.4, 0.0, 1.44, 0.0};
  configuration.sensors.position_resolution = 2.4e-5;
  configuration.sensors.velocity_noise = 1e-3;
  configuration.sensors.effort_noise = 1e-2;
  return configuration;
}

/// A command every 20 ms, as from a joystick; the arm swings to and fro, away from its limits.
Cost measureArm(const RobotDescription& description, const SimulatedArmConfiguration& configuration) {
  SimulatedArm arm(description, configuration);
  Nanoseconds now = 0;
  std::vector<ArmCommand> commands;
  return measure([&] {
    now += kMillisecond;
    commands.clear();
    if (now % (20 * kMillisecond) == 0) {
      const double swing = 0.2 * std::sin(2.0 * M_PI * toSeconds(now));
      ArmCommand command;
      command.mode = configuration.mode;
      command.values = Eigen::VectorXd::Constant(configuration.mode == ControlMode::cartesian_velocity ? 6 : 7, swing);
      commands.push_back(command);
    }
    arm.tick(now, commands);
  });
}

void run() {
  const RobotDescription arm = describeDemoArm();
  RobotDescription frictionless = arm;
  for (ArmJoint& joint : frictionless.joints) joint.friction = joint.damping = 0.0;

  std::printf(
      "| one simulated millisecond of the 7-joint demo arm | µs, median | µs, best batch | times real time |\n");
  std::printf("|---|---|---|---|\n");
  printRow("Cartesian velocity, friction, 4 sub-steps, sensors",
           measureArm(arm, atWork(ControlMode::cartesian_velocity)));
  printRow("joint velocity, friction, 4 sub-steps, sensors", measureArm(arm, atWork(ControlMode::velocity)));
  printRow("the same without friction", measureArm(frictionless, atWork(ControlMode::velocity)));
  SimulatedArmConfiguration coarse = atWork(ControlMode::velocity);
  coarse.substeps = 1;
  printRow("joint velocity, friction, 1 sub-step, sensors", measureArm(arm, coarse));

  BulletArm physics(arm);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(7);
  const ArmState start = physics.state();
  int calls = 0;
  printRow("physics alone, friction, 4 sub-steps", measure([&] {
             if (++calls % 200 == 0) physics.reset(start);
             physics.step(none, 0.001, 4);
           }));
}

}  // namespace
}  // namespace demo_logger

int main() {
  demo_logger::run();
  return 0;
}
