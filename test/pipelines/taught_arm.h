#pragma once

// A demonstration by hand in simulation, with the truth beside it: for tests and for bench/human_torque.cpp.

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/simulation/simulated_arm.h"
#include "demo_logger/simulation/simulated_hand.h"
#include "demo_logger/trajectory/demonstration.h"
#include "test/simulation/arms.h"

namespace demo_logger {

struct Teaching {
  std::string task = "reach";
  std::uint64_t seed = 1;
  bool coulomb_friction = false;       // of the joints, beside the viscous one that they always have
  std::optional<BodyInertia> payload;  // that the arm's own controller does not know
  double own_motion = 0.0;             // [s] in which the arm moves by itself before the hand comes
  double encoder_step = 0.0;           // [rad]
  double position_noise = 0.0;         // [rad]
  Integrator integrator = Integrator::semi_implicit_euler;
};

inline double encoderStep(int bits) { return 2.0 * M_PI / std::pow(2.0, bits); }

/// One row for each control tick of 1 ms.
struct TaughtRecording {
  Demonstration log;         // q_ and tau_ as the sensors have them
  Eigen::MatrixXd q, dq;     // truth, rows x joints
  Eigen::MatrixXd torque;    // ditto, the hand's: at a tick, where it steps, the mean of before and after
  double taught_from = 0.0;  // [s] in which the arm complies
  double taught_to = 0.0;
};

/// The arm that is taught, as its manufacturer knows it.
inline RobotDescription taughtArm(bool coulomb_friction = false) {
  RobotDescription arm = describeDemoArm();
  for (ArmJoint& joint : arm.joints) {
    if (!coulomb_friction) joint.friction = 0.0;
  }
  return arm;
}

namespace taught_arm_detail {

/// Swings about its first posture by itself, each joint at its own pace, from rest and back to rest.
inline std::vector<ArmCommand> ownMotion(const Teaching& teaching) {
  constexpr double kStep = 0.02;      // [s]
  constexpr double kAmplitude = 0.5;  // [rad]
  const double duration = teaching.own_motion - 1.0;
  const auto positionAt = [&](double t, Eigen::Index i) {
    const double ramp = std::clamp(std::min(t, duration - t) / 1.5, 0.0, 1.0);
    const double grown = ramp * ramp * ramp * (10.0 + ramp * (-15.0 + 6.0 * ramp));
    const double pace = 0.17 + 0.03 * static_cast<double>(i) + 0.01 * static_cast<double>(teaching.seed % 5);  // [Hz]
    return bentPosition()[static_cast<std::size_t>(i)] +
           grown * kAmplitude * std::sin(2.0 * M_PI * pace * t + 0.9 * static_cast<double>(i));
  };
  ArmCommand command;
  command.mode = ControlMode::trajectory;
  command.source = "/own_motion";
  for (double t = kStep; t < duration + 0.5 * kStep; t += kStep) {
    PathPoint point;
    point.time = t;
    point.q.resize(7);
    point.dq.resize(7);
    for (Eigen::Index i = 0; i < 7; ++i) {
      constexpr double kAside = 1e-4;
      point.q[i] = positionAt(t, i);
      point.dq[i] = (positionAt(t + kAside, i) - positionAt(t - kAside, i)) / (2.0 * kAside);
    }
    command.path.push_back(point);
  }
  command.path.back().dq.setZero();
  return {command};
}

}  // namespace taught_arm_detail

inline TaughtRecording teach(const Teaching& teaching) {
  const RobotDescription description = taughtArm(teaching.coulomb_friction);
  SimulatedArmConfiguration configuration =
      makeArmConfiguration(teaching.own_motion > 0.0 ? ControlMode::trajectory : ControlMode::gravity_compensation);
  configuration.integrator = teaching.integrator;
  configuration.sensors.position_resolution = teaching.encoder_step;
  configuration.sensors.position_noise = teaching.position_noise;
  configuration.sensors.seed = teaching.seed;
  configuration.load_declared = false;
  configuration.controller.command_timeout = 10.0;
  SimulatedArm arm(description, configuration);
  arm.setLoad(teaching.payload);
  SimulatedHandConfiguration hand_configuration;
  hand_configuration.task = handTask(teaching.task);
  hand_configuration.seed = teaching.seed;
  SimulatedHand hand(hand_configuration);
  const RobotModel model(description);

  TaughtRecording recording;
  std::vector<ArmTick> ticks;
  std::vector<Eigen::VectorXd> torques;
  Eigen::VectorXd before = Eigen::VectorXd::Zero(6);
  Eigen::VectorXd wrench = before;  // in force from this tick on
  const auto own = static_cast<int>(1000.0 * teaching.own_motion);
  for (int k = 0; k < own || !hand.finished(); ++k) {
    const Nanoseconds now = kNanosecondsPerSecond + k * kMillisecond;
    ticks.push_back(
        arm.tick(now, own > 0 && k == 1 ? taught_arm_detail::ownMotion(teaching) : std::vector<ArmCommand>()));
    const ArmState& state = ticks.back().truth;
    const Eigen::MatrixXd J = model.jacobian(state.q);
    torques.push_back(J.transpose() * (0.5 * (before + wrench)));
    before = wrench;
    if (k < own) continue;
    SeenTool seen;
    seen.X_base_tool = model.forwardKinematics(state.q);
    seen.twist = J * state.dq;
    const HandAction action = hand.act(now, seen);
    if (own > 0 && action.holds && recording.taught_from == 0.0) {
      arm.setMode(ControlMode::gravity_compensation);
      recording.taught_from = 1e-3 * (k + 1);
    }
    wrench << action.wrench.force, action.wrench.torque;
    arm.applyWrench({6, description.X_lastlink_tip.translation(), action.wrench.force, action.wrench.torque, false},
                    now + 2 * kMillisecond, "/hand");
  }
  const auto rows = static_cast<Eigen::Index>(ticks.size());
  recording.taught_to = 1e-3 * static_cast<double>(rows - 1);
  for (const char* prefix : {"q_", "tau_"}) {
    for (const std::string& joint : description.jointNames()) {
      recording.log.columns.push_back({prefix + joint, "", Role::state, Interpolation::linear, ""});
    }
  }
  recording.log.values.resize(rows, 14);
  recording.q = recording.dq = recording.torque = Eigen::MatrixXd(rows, 7);
  for (Eigen::Index k = 0; k < rows; ++k) {
    const ArmTick& tick = ticks[static_cast<std::size_t>(k)];
    recording.log.time.push_back(1e-3 * static_cast<double>(k));
    recording.log.values.row(k) << tick.reading.q.transpose(), tick.reading.effort.transpose();
    recording.q.row(k) = tick.truth.q;
    recording.dq.row(k) = tick.truth.dq;
    recording.torque.row(k) = torques[static_cast<std::size_t>(k)];
  }
  recording.log.metadata.effort.timing = "held";
  recording.log.metadata.effort.control_period = 1e-3;
  return recording;
}

/// Each `step`-th row, as a slower log has them.
inline TaughtRecording thinned(const TaughtRecording& recording, Eigen::Index step) {
  TaughtRecording thin = recording;
  const Eigen::Index rows = (recording.q.rows() + step - 1) / step;
  thin.log.time.clear();
  thin.log.values.resize(rows, 14);
  thin.q = thin.dq = thin.torque = Eigen::MatrixXd(rows, 7);
  for (Eigen::Index k = 0; k < rows; ++k) {
    thin.log.time.push_back(recording.log.time[static_cast<std::size_t>(k * step)]);
    thin.log.values.row(k) = recording.log.values.row(k * step);
    thin.q.row(k) = recording.q.row(k * step);
    thin.dq.row(k) = recording.dq.row(k * step);
    thin.torque.row(k) = recording.torque.row(k * step);
  }
  return thin;
}

/// The log of a driver that wakes up unevenly: positions at those instants, rounded by the encoder, and the command
/// that is in force then.
inline TaughtRecording jittered(const TaughtRecording& recording, double jitter, double encoder_step,
                                std::uint64_t seed) {
  TaughtRecording uneven = recording;
  std::mt19937 random(static_cast<std::uint32_t>(seed));
  std::normal_distribution<double> normal(0.0, jitter);
  const Eigen::Index rows = recording.q.rows();
  double last = -1.0;
  for (Eigen::Index k = 0; k < rows; ++k) {
    const double t = std::clamp(1e-3 * static_cast<double>(k) + normal(random), last + 1e-5, 1e-3 * (rows - 1.001));
    last = t;
    const auto before = static_cast<Eigen::Index>(std::floor(std::max(0.0, t) * 1e3));
    const double s = std::max(0.0, t) * 1e3 - static_cast<double>(before);
    uneven.log.time[static_cast<std::size_t>(k)] = t;
    for (Eigen::Index i = 0; i < 7; ++i) {
      // Hermite's cubic through positions and velocities.
      const double q0 = recording.q(before, i), q1 = recording.q(before + 1, i);
      const double v0 = 1e-3 * recording.dq(before, i), v1 = 1e-3 * recording.dq(before + 1, i);
      const double q = q0 + s * (v0 + s * (3.0 * (q1 - q0) - 2.0 * v0 - v1 + s * (v0 + v1 - 2.0 * (q1 - q0))));
      uneven.log.values(k, i) = std::round(q / encoder_step) * encoder_step;
      uneven.log.values(k, 7 + i) = recording.log.values(before, 7 + i);
      uneven.torque(k, i) = (1.0 - s) * recording.torque(before, i) + s * recording.torque(before + 1, i);
    }
  }
  return uneven;
}

/// Root mean square over all joints and rows, without 0.25 s at either end of the teaching, over the largest torque of
/// any joint: in percent. NaN, which is below no bound, if any of these rows lacks a torque.
inline double percentOff(const TaughtRecording& recording, const Eigen::MatrixXd& recovered) {
  constexpr double kEdge = 0.25;  // [s]
  double squares = 0.0;
  double count = 0.0;
  for (Eigen::Index k = 0; k < recovered.rows(); ++k) {
    const double t = recording.log.time[static_cast<std::size_t>(k)];
    if (t < recording.taught_from + kEdge || t > recording.taught_to - kEdge) continue;
    squares += (recovered.row(k) - recording.torque.row(k)).squaredNorm();
    count += static_cast<double>(recovered.cols());
  }
  return 100.0 * std::sqrt(squares / count) / recording.torque.cwiseAbs().maxCoeff();
}

/// The columns of all joints that begin with `prefix`, of a recording with torques.
inline Eigen::MatrixXd jointColumns(const Demonstration& demonstration, const std::string& prefix) {
  Eigen::MatrixXd columns(demonstration.values.rows(), 7);
  Eigen::Index found = 0;
  for (std::size_t i = 0; i < demonstration.columns.size() && found < 7; ++i) {
    if (demonstration.columns[i].name == prefix + "joint_" + std::to_string(found + 1)) {
      columns.col(found++) = demonstration.values.col(static_cast<Eigen::Index>(i));
    }
  }
  return columns;
}

}  // namespace demo_logger
