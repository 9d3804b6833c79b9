#include "src/nodes/simulated_arm_parameters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "demo_logger/simulation/compliance.h"
#include "demo_logger/trajectory/print.h"
#include "src/ros/parameters.h"

namespace demo_logger {
namespace {

Range anyNumber(const std::string& unit) {
  Range range;
  range.unit = unit;
  return range;
}

const Range kSeeds{0.0, std::numeric_limits<int>::max(), ""};  // what a parameter can hold

SensorConfiguration readSensors(Parameters parameters) {
  SensorConfiguration sensors;
  sensors.position_noise = parameters.number("position_noise", sensors.position_noise, {0.0, INFINITY, "rad or m"});
  sensors.position_resolution =
      parameters.number("position_resolution", sensors.position_resolution, {0.0, INFINITY, "rad or m"});
  sensors.velocity_noise = parameters.number("velocity_noise", sensors.velocity_noise, {0.0, INFINITY, "rad/s or m/s"});
  sensors.effort_noise = parameters.number("effort_noise", sensors.effort_noise, {0.0, INFINITY, "N m or N"});
  sensors.position_bias = parameters.numbers("position_bias", {}, anyNumber("rad or m"));
  sensors.velocity_from_positions = parameters.flag("velocity_from_positions", sensors.velocity_from_positions);
  sensors.velocity_cutoff = parameters.number("velocity_cutoff", sensors.velocity_cutoff, {0.0, INFINITY, "Hz"});
  sensors.effort_side =
      parameters.choice("effort_side", "motor", {"motor", "link"}) == "link" ? EffortSide::link : EffortSide::motor;
  sensors.seed = static_cast<std::uint64_t>(parameters.integer("seed", 1, kSeeds));
  parameters.rejectUnknown();
  return sensors;
}

JointStateFaultsConfiguration readFaults(Parameters parameters) {
  JointStateFaultsConfiguration faults;
  faults.delay = parameters.number("delay", faults.delay, {0.0, 10.0, "s"});
  faults.jitter = parameters.number("jitter", faults.jitter, {0.0, 10.0, "s"});
  faults.drop = parameters.number("drop", faults.drop, {0.0, 1.0, ""});
  faults.duplicate = parameters.number("duplicate", faults.duplicate, {0.0, 1.0, ""});
  faults.zero_stamp = parameters.number("zero_stamp", faults.zero_stamp, {0.0, 1.0, ""});
  faults.permute = parameters.number("permute", faults.permute, {0.0, 1.0, ""});
  faults.split = parameters.integer("split", faults.split, {0.0, INFINITY, "joints"});
  faults.gripper = parameters.texts("gripper", {});
  faults.seed = static_cast<std::uint64_t>(parameters.integer("seed", 1, kSeeds));
  parameters.rejectUnknown();
  return faults;
}

std::vector<double> readNumbers(Parameters& parameters, const std::string& key, std::size_t size,
                                const std::vector<double>& fallback, const Range& range) {
  std::vector<double> numbers = parameters.numbers(key, fallback, range);
  if (numbers.size() == size || (fallback.empty() && numbers.empty())) return numbers;
  throw ConfigurationError(parameters.fullName(key) + " has " + std::to_string(numbers.size()) + " numbers, expected " +
                           std::to_string(size) + ".");
}

Eigen::Vector3d readVector(Parameters& parameters, const std::string& key, const std::string& unit) {
  const std::vector<double> numbers = readNumbers(parameters, key, 3, {0.0, 0.0, 0.0}, anyNumber(unit));
  return {numbers[0], numbers[1], numbers[2]};
}

CollisionShape readObstacle(Parameters parameters) {
  using Kind = CollisionShape::Kind;
  CollisionShape shape;
  const std::string type = parameters.choice("type", "box", {"box", "sphere", "cylinder"});
  shape.kind = type == "box" ? Kind::box : type == "sphere" ? Kind::sphere : Kind::cylinder;
  const std::size_t numbers = type == "box" ? 3 : type == "sphere" ? 1 : 2;
  const std::vector<double> size =
      readNumbers(parameters, "size", numbers, std::vector<double>(numbers, 0.1), {1e-3, 100.0, "m"});
  std::copy(size.begin(), size.end(), shape.size.begin());
  shape.pose.translation() = readVector(parameters, "position", "m");
  const Eigen::Vector3d rpy = readVector(parameters, "rpy", "rad");
  shape.pose.linear() =
      (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  parameters.rejectUnknown();
  return shape;
}

Surroundings readSurroundings(Parameters& parameters) {
  Surroundings surroundings;
  const bool has_floor = parameters.has("floor");
  const double floor = parameters.number("floor", 0.0, {-100.0, 100.0, "m"});
  if (has_floor) surroundings.floor = floor;
  surroundings.friction = parameters.number("contact_friction", surroundings.friction, {0.0, 10.0, ""});
  for (Parameters& obstacle : parameters.groups("obstacles")) {
    surroundings.obstacles.push_back(readObstacle(std::move(obstacle)));
  }
  return surroundings;
}

std::optional<BodyInertia> readLoad(Parameters& parameters) {
  const bool present = parameters.has("load");
  Parameters group = parameters.group("load");
  BodyInertia load;
  load.mass = group.number("mass", 0.0, {0.0, 1000.0, "kg"});
  load.center = readVector(group, "center", "m");
  const std::vector<double> moments = readNumbers(group, "inertia", 6, std::vector<double>(6, 0.0), anyNumber("kg m2"));
  load.inertia << moments[0], moments[1], moments[2], moments[1], moments[3], moments[4], moments[2], moments[4],
      moments[5];
  group.rejectUnknown();
  if (!present || load.mass == 0.0) return std::nullopt;
  return load;
}

/// Per joint, what the URDF has no place for or states otherwise.
RobotDescription readDrives(Parameters parameters, const RobotDescription& robot) {
  const std::size_t size = robot.joints.size();
  const Range range{0.0, INFINITY, ""};
  const std::vector<double> motor_inertia = readNumbers(parameters, "motor_inertia", size, {}, range);
  const std::vector<double> damping = readNumbers(parameters, "damping", size, {}, range);
  const std::vector<double> friction = readNumbers(parameters, "friction", size, {}, range);
  parameters.rejectUnknown();
  std::map<std::string, JointDrive> drives;
  for (std::size_t i = 0; i < size; ++i) {
    JointDrive& drive = drives[robot.joints[i].name];
    if (!motor_inertia.empty()) drive.motor_inertia = motor_inertia[i];
    if (!damping.empty()) drive.damping = damping[i];
    if (!friction.empty()) drive.friction = friction[i];
  }
  return withDrives(robot, drives);
}

struct Gains {
  std::vector<double> stiffness;
  std::vector<double> damping;
};

Gains readImpedance(Parameters parameters) {
  Gains gains;
  gains.stiffness = parameters.numbers("stiffness", {}, {0.0, kLargestGain, "N m/rad or N/m"});
  gains.damping = parameters.numbers("damping", {}, {0.0, kLargestGain, "N m s/rad or N s/m"});
  parameters.rejectUnknown();
  return gains;
}

/// One for all joints becomes one for each.
Eigen::VectorXd spread(const std::vector<double>& values, std::size_t joints) {
  if (values.size() == 1) return Eigen::VectorXd::Constant(static_cast<Eigen::Index>(joints), values.front());
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

int ticksPerJointState(Parameters& parameters, int control_rate) {
  const double rate = parameters.number("publish_rate", 500.0, {1.0, static_cast<double>(control_rate), "Hz"});
  const double ticks = control_rate / rate;
  if (std::abs(ticks - std::round(ticks)) > 1e-9) {
    throw ConfigurationError(parameters.fullName("publish_rate") + " is " + print(rate) +
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
    throw ConfigurationError(parameters.fullName("real_time_factor") + " is " + print(clock.speed) +
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
  const Gains impedance = readImpedance(parameters.group("impedance"));
  arm.integrator = parameters.choice("integrator", "semi_implicit_euler", {"semi_implicit_euler", "runge_kutta_4"}) ==
                           "runge_kutta_4"
                       ? Integrator::runge_kutta_4
                       : Integrator::semi_implicit_euler;
  arm.surroundings = readSurroundings(parameters);
  arm.load_declared = parameters.flag("load_declared", arm.load_declared);
  result.load = readLoad(parameters);
  result.wrench_timeout = parameters.number("wrench_timeout", result.wrench_timeout, {0.001, 60.0, "s"});
  result.initial_state = parameters.text("initial_state", "");
  result.state_dir = parameters.text("state_dir", "");
  result.faults = readFaults(parameters.group("joint_state_faults"));
  const Parameters drives = parameters.group("drives");
  parameters.rejectUnknown();

  const std::string urdf = readRobotDescription(private_node);
  result.robot = readDrives(drives, describeRobot(urdf, chain));
  for (const std::string& warning : result.robot.warnings) ROS_WARN_STREAM(warning);
  const std::size_t joints = result.robot.joints.size();
  controller.impedance = {spread(impedance.stiffness, joints), spread(impedance.damping, joints)};
  result.links = attachedLinks(urdf, chain);
  arm.surroundings.links = result.links;
  validate(result.faults, result.robot.jointNames());
  return result;
}

}  // namespace demo_logger
