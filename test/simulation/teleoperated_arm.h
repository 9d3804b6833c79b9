#pragma once

#include <functional>
#include <vector>

#include "demo_logger/channels/teleoperation.h"
#include "demo_logger/robot/robot_model.h"
#include "demo_logger/simulation/simulated_arm.h"
#include "demo_logger/simulation/simulated_human.h"
#include "test/simulation/arms.h"

namespace demo_logger {

/// Six axes, like those of a six-axis mouse: three slide with 0.25 m/s, three turn with 0.8 rad/s; button 0 enables.
inline TeleoperationConfiguration makeSixAxisDevice() {
  TeleoperationConfiguration device;
  device.map.outputs = {"u_vx", "u_vy", "u_vz", "u_wx", "u_wy", "u_wz"};
  device.map.gain = Eigen::MatrixXd::Zero(6, 6);
  device.map.gain.diagonal() << 0.25, 0.25, 0.25, 0.8, 0.8, 0.8;
  device.map.offset = Eigen::VectorXd::Zero(6);
  device.map.dead_zone = 0.02;
  for (int i = 0; i < 6; ++i) {
    device.map.inputs.push_back("joy_axis" + std::to_string(i));
    device.axes.push_back(i);
  }
  device.enable_button = 0;
  return device;
}

struct TeleoperatedTick {
  ArmTick arm;
  DeviceReading reading;  // the last one
};

/// The whole loop without ROS and without waiting: the human sees the tool, moves the device every reading period, and
/// the arm gets the commands. Calls `look` after each control tick.
inline void teleoperate(SimulatedHumanConfiguration configuration,
                        const std::function<void(const TeleoperatedTick&)>& look) {
  configuration.device = makeSixAxisDevice();
  SimulatedArm arm = makeDemoArm(ControlMode::cartesian_velocity);
  const RobotModel model(describeDemoArm());
  Teleoperation teleoperation(configuration.device);
  SimulatedHuman human(configuration);
  const auto ticks_per_reading = static_cast<int>(configuration.reading_period * 1000.0);
  TeleoperatedTick tick;
  Nanoseconds now = kNanosecondsPerSecond;
  tick.arm = arm.tick(now, {});
  for (int k = 1; !human.finished(); ++k) {
    now += kMillisecond;
    std::vector<ArmCommand> commands;
    if (k % ticks_per_reading == 0) {
      tick.reading = human.next(now, model.forwardKinematics(tick.arm.truth.q));
      if (const auto command = teleoperation.receive(tick.reading)) {
        ArmCommand& sent = commands.emplace_back();
        sent.mode = ControlMode::cartesian_velocity;
        sent.values = command->output.value;
        sent.stamp = command->stamp;
        sent.source = "/teleop";
      }
    }
    tick.arm = arm.tick(now, commands);
    look(tick);
  }
}

}  // namespace demo_logger
