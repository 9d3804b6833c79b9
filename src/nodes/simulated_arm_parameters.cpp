#include "src/nodes/simulated_arm_parameters.h"

#include <cmath>

#include "src/ros/parameters.h"

namespace demo_logger {
namespace {

SensorConfiguration readSensors(Parameters parameters) {
  SensorConfiguration sensors;
  sensors.position_noise = parameters.number("position_noise", sensors.position_noise, {0.0, INFINITY, "rad or m"});
  sensors.position_resolution =
      parameters.number("position_resolution", sensors.position_resolution, {0.0, INFINITY, "rad or m"});
  sensors.velocity_noise = parameters.number("velocity_noise", sensors.velocity_noise, {0.0, INFINITY, "rad/s or m/s"});
  sensors.effort_noise = parameters.number("effort_noise", sensors.effort_noise, {0.0, INFINITY, "N m or N"});
  sensors.seed = static_cast<std::uint64_t>(parameters.integer("seed", 1, {0.0, INFINITY, ""}));
  parameters.rejectUnknown();
  return sensors;
}

int ticksPerJointState(Parameters& parameters, int control_rate) {
  const double rate = parameters.number("publish_rate", 500.0, {1.0, static_cast<double>(control_rate), "Hz"});
  const double ticks = control_rate / rate;
  if (std::abs(ticks - std::round(ticks)) > 1e-9) {
    throw ConfigurationError(parameters.fullName("publish_rate") + " is " + std::to_string(rate) +
                             " Hz, expected a whole part of the control rate of " + std::to_string(control_rate) +
                             " Hz, as joint states are those of control ticks.");
  }
  return static_cast<int>(std::lround(ticks));
}

TickClock::Configuration readClock(Parameters& parameters, const ros::NodeHandle& node, int control_rate) {
  TickClock::Configuration clock;
  clock.period = kNanosecondsPerSecond / control_rate;
  clock.own_time = parameters.flag("publish_clock", false);
  clock.speed = parameters.number("real_time_factor", 1.0, {0.0, 1000.0, ""});
  if (!clock.own_time && clock.speed != 1.0) {
    throw ConfigurationError(parameters.fullName("real_time_factor") + " is " + std::to_string(clock.speed) +
                             ", expected 1 unless " + parameters.fullName("publish_clock") + " is true.");
  }
  bool use_sim_time = false;
  node.getParam("/use_sim_time", use_sim_time);
  if (use_sim_time && !clock.own_time) {
    throw ConfigurationError("/use_sim_time is true, expected false unless " + parameters.fullName("publish_clock") +
                             " is true: the simulated arm follows no other simulation's clock.");
  }
  return clock;
}

}  // namespace

SimulatedArmParameters readSimulatedArmParameters(const ros::NodeHandle& private_node) {
  Parameters parameters = readParameters(private_node);
  SimulatedArmParameters result;

  DescriptionOptions chain;
  chain.base = parameters.text("base", "");
  chain.tip = parameters.text("tip", "");

  SimulatedArmConfiguration& arm = result.arm;
  arm.mode = toControlMode(parameters.choice("control_mode", "cartesian_velocity", controlModeNames()));
  arm.initial_position = parameters.numbers("initial_position", {});
  arm.substeps = parameters.integer("substeps", arm.substeps, {1.0, 100.0, ""});
  arm.sensors = readSensors(parameters.group("sensors"));

  const int control_rate = parameters.integer("control_rate", 1000, {100.0, 4000.0, "Hz"});
  result.clock = readClock(parameters, private_node, control_rate);
  result.ticks_per_joint_state = ticksPerJointState(parameters, control_rate);

  ArmControllerConfiguration& controller = arm.controller;
  controller.control_period = toSeconds(result.clock.period);
  controller.command_timeout = parameters.number("command_timeout", controller.command_timeout, {0.01, 60.0, "s"});
  controller.max_acceleration =
      parameters.number("max_acceleration", controller.max_acceleration, {0.01, 1000.0, "rad/s2 or m/s2"});
  controller.velocity_gain =
      parameters.number("velocity_gain", controller.velocity_gain, {1.0, control_rate / 2.0, "1/s"});
  controller.position_gain =
      parameters.number("position_gain", controller.position_gain, {0.1, controller.velocity_gain / 2.0, "1/s"});
  controller.effort_gravity_compensation =
      parameters.flag("effort_gravity_compensation", controller.effort_gravity_compensation);
  controller.position_margin = parameters.number("position_margin", controller.position_margin, {0.0, 0.5, "rad or m"});
  parameters.rejectUnknown();

  result.robot = describeRobot(readRobotDescription(private_node), chain);
  for (const std::string& warning : result.robot.warnings) ROS_WARN_STREAM(warning);
  return result;
}

}  // namespace demo_logger
