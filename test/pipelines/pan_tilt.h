#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

#include "demo_logger/robot/robot_description.h"
#include "demo_logger/trajectory/demonstration.h"

namespace demo_logger {

/// An arm of two joints, whose dynamics are short enough to be written down here, independently of any robot model.
struct PanTilt {
  // What the description claims of it.
  double damping = 0.0;   // [N m s/rad]
  double friction = 0.0;  // [N m]

  static constexpr double kMass = 1.0;     // [kg] of the link that tilts
  static constexpr double kCenter = 0.3;   // [m] from the tilting axis
  static constexpr double kAround = 0.01;  // [kg m²] its inertia about the centre, across
  static constexpr double kAlong = 0.001;  // [kg m²] ditto, along the link
  static constexpr double kPan = 0.01;     // [kg m²] of the link that only pans
  static constexpr double kTip = 0.5;      // [m]
  static constexpr double kGravity = 9.81;
  static constexpr double kFrictionVelocity = 0.02;  // [rad/s]

  RobotDescription describe() const {
    const auto joint = [&](const std::string& name, const std::string& parent, const std::string& child,
                           const std::string& axis) {
      return "<joint name='" + name + "' type='revolute'><parent link='" + parent + "'/><child link='" + child +
             "'/><axis xyz='" + axis + "'/><limit lower='-3' upper='3' effort='50' velocity='2'/><dynamics damping='" +
             std::to_string(damping) + "' friction='" + std::to_string(friction) + "'/></joint>";
    };
    const std::string urdf =
        "<robot name='pan_tilt'><link name='base'/>"
        "<link name='pan'><inertial><mass value='2'/><origin xyz='0 0 0'/>"
        "<inertia ixx='0.01' ixy='0' ixz='0' iyy='0.01' iyz='0' izz='0.01'/></inertial></link>"
        "<link name='arm'><inertial><mass value='1'/><origin xyz='0.3 0 0'/>"
        "<inertia ixx='0.001' ixy='0' ixz='0' iyy='0.01' iyz='0' izz='0.01'/></inertial></link><link name='tool'/>" +
        joint("pan", "base", "pan", "0 0 1") + joint("tilt", "pan", "arm", "0 1 0") +
        "<joint name='tip' type='fixed'><parent link='arm'/><child link='tool'/><origin xyz='0.5 0 0'/></joint>"
        "</robot>";
    DescriptionOptions options;
    options.base = "base";
    options.tip = "tool";
    options.gravity = kGravity;
    RobotDescription robot = describeRobot(urdf, options);
    for (ArmJoint& described : robot.joints) described.friction_velocity = kFrictionVelocity;
    return robot;
  }
};

/// What it does, without a hand.
struct PanTiltRun {
  double duration = 10.0;                   // [s]
  double rate = 200.0;                      // [Hz]
  double payload = 0.0;                     // [kg] a point at the tip
  double damping = 0.0;                     // [N m s/rad]
  double friction = 0.0;                    // [N m], risen at kFrictionVelocity
  double noise = 0.01;                      // [N m] of the efforts, white
  double encoder_step = 2.4e-5;             // [rad]
  double pan_amplitude = 1.0;               // of what it usually moves
  std::array<double, 2> bias = {0.0, 0.0};  // [N m]
  std::string side = "motor";
};

inline Demonstration record(const PanTiltRun& run, std::uint32_t seed) {
  constexpr double kPi = 3.14159265358979323846;
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  struct Motion {
    double q, dq, ddq;
  };
  const auto motion = [&](double t, double a, double b, double frequency) {
    const double w = 2.0 * kPi * frequency;
    const double v = 2.3 * w;
    return Motion{a * std::sin(w * t) + b * std::sin(v * t), a * w * std::cos(w * t) + b * v * std::cos(v * t),
                  -a * w * w * std::sin(w * t) - b * v * v * std::sin(v * t)};
  };
  const auto encoder = [&](double q) {
    return run.encoder_step > 0.0 ? std::round(q / run.encoder_step) * run.encoder_step : q;
  };
  const auto drive = [&](double dq) {
    return run.damping * dq + run.friction * std::tanh(dq / PanTilt::kFrictionVelocity);
  };
  Demonstration demonstration;
  for (const char* const name : {"q_pan", "q_tilt", "tau_pan", "tau_tilt"}) {
    demonstration.columns.push_back({name, "", Role::state, Interpolation::linear, ""});
  }
  const auto rows = static_cast<Eigen::Index>(run.duration * run.rate);
  demonstration.values.resize(rows, 4);
  // About the tilting axis; across the link all of it, along it nearly nothing.
  const double tip = run.payload * PanTilt::kTip * PanTilt::kTip;
  const double across = PanTilt::kAround + PanTilt::kMass * PanTilt::kCenter * PanTilt::kCenter + tip;
  const double leverage = PanTilt::kMass * PanTilt::kCenter + run.payload * PanTilt::kTip;
  for (Eigen::Index k = 0; k < rows; ++k) {
    const double t = static_cast<double>(k) / run.rate;
    demonstration.time.push_back(t);
    const Motion pan = motion(t, 0.4 * run.pan_amplitude, 0.2 * run.pan_amplitude, 0.31);
    const Motion tilt = motion(t, 0.5, 0.3, 0.4);
    const double s = std::sin(tilt.q);
    const double c = std::cos(tilt.q);
    const double inertia = PanTilt::kPan + PanTilt::kAlong * s * s + across * c * c;
    const double slope = -2.0 * (across - PanTilt::kAlong) * s * c;  // of that, per tilt
    demonstration.values.row(k) << encoder(pan.q), encoder(tilt.q),
        inertia * pan.ddq + slope * pan.dq * tilt.dq + drive(pan.dq) + run.bias[0] + run.noise * normal(random),
        across * tilt.ddq - 0.5 * slope * pan.dq * pan.dq - PanTilt::kGravity * leverage * c + drive(tilt.dq) +
            run.bias[1] + run.noise * normal(random);
  }
  demonstration.metadata.effort.side = run.side;
  demonstration.metadata.effort.timing = "instant";
  return demonstration;
}

}  // namespace demo_logger
