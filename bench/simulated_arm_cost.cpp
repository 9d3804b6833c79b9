// What one simulated millisecond costs: physics, friction, control and sensors of an arm at work, in CPU time; and how
// far either integrator drifts from the energy of an undamped fall. Prints tables in Markdown.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/simulation/simulated_arm.h"
#include "test/simulation/energy.h"

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

/// Largest |E − E₀| [J] in 5 s of 1 kHz, the worst of several falls from rest; infinite if one diverges.
double energyDrift(const RobotDescription& arm, Integrator integrator, int substeps) {
  double worst = 0.0;
  for (const double shoulder : {0.3, 0.8, 1.2, M_PI / 2.0, 2.0}) {
    BulletArm body(arm, {}, integrator);
    Eigen::VectorXd q = Eigen::VectorXd::Zero(7);
    q[1] = shoulder;
    body.reset({q, Eigen::VectorXd::Zero(7)});
    const Energy energy(arm);
    const double start = energy(body.state());
    for (int tick = 0; tick < 5000; ++tick) {
      body.step(Eigen::VectorXd::Zero(7), 0.001, substeps);
      if (!body.state().dq.allFinite()) return INFINITY;
      worst = std::max(worst, std::abs(energy(body.state()) - start));
    }
  }
  return worst;
}

void printDrifts(RobotDescription arm) {
  for (ArmJoint& joint : arm.joints) {
    joint.friction = joint.damping = 0.0;
    joint.lower = -1e9;
    joint.upper = 1e9;
  }
  std::printf("\n| energy drift [J], worst of five undamped falls of 5 s at 1 kHz | 1 step a ms | 2 | 4 |\n");
  std::printf("|---|---|---|---|\n");
  for (const Integrator integrator : {Integrator::runge_kutta_4, Integrator::semi_implicit_euler}) {
    std::printf("| %s |", integrator == Integrator::runge_kutta_4 ? "reference mode" : "default");
    for (const int substeps : {1, 2, 4}) std::printf(" %.2g |", energyDrift(arm, integrator, substeps));
    std::printf("\n");
  }
}

void run(const std::string& part) {
  const RobotDescription arm = describeDemoArm();
  if (part == "drift") return printDrifts(arm);
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

  SimulatedArmConfiguration reference = atWork(ControlMode::velocity);
  reference.integrator = Integrator::runge_kutta_4;
  printRow("joint velocity, reference mode, 4 sub-steps", measureArm(arm, reference));
  SimulatedArmConfiguration cluttered = atWork(ControlMode::velocity);
  cluttered.surroundings.floor = 0.0;
  cluttered.surroundings.obstacles.push_back(
      {CollisionShape::Kind::box, {0.2, 0.2, 0.2}, Eigen::Isometry3d::Identity()});
  cluttered.surroundings.obstacles[0].pose.translation() = Eigen::Vector3d(0.8, 0.0, 0.1);
  printRow("joint velocity, friction, a floor and a box in reach", measureArm(arm, cluttered));

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

/// `simulated_arm_cost` prints the costs, `simulated_arm_cost drift` the drifts.
int main(int argc, char** argv) {
  demo_logger::run(argc > 1 ? argv[1] : "");
  return 0;
}
