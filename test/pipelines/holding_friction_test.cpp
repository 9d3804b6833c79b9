// A joint whose friction holds it, in closed form: I q̈ = τ_h − F sign(q̇), and q̈ = 0 while it stands and |τ_h| < F.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "demo_logger/pipelines/human_torque.h"
#include "demo_logger/trajectory/motion_smoother.h"

namespace demo_logger {
namespace {

using Index = Eigen::Index;

constexpr double kInertia = 0.05;                                   // [kg m²]
constexpr double kFriction = 0.4;                                   // [N m]
constexpr double kEncoderStep = 2.0 * 3.14159265358979 / 262144.0;  // [rad]

/// One joint about the vertical, which gravity does not turn.
RobotDescription turntable(double friction) {
  const std::string urdf = R"(<robot name="turntable"><link name="base"/><link name="table">
    <inertial><mass value="2"/><inertia ixx="0.05" iyy="0.05" izz="0.05" ixy="0" ixz="0" iyz="0"/></inertial></link>
    <joint name="turn" type="continuous"><parent link="base"/><child link="table"/><axis xyz="0 0 1"/>
    <dynamics damping="0" friction=")" +
                           std::to_string(friction) + R"("/></joint></robot>)";
  return describeRobot(urdf, {"base", "table", {}, 9.81});
}

/// A hand whose torque falls evenly, τ_h = start − slope · t, brings the turning joint to zero and pulls it back.
struct Pull {
  double start;  // [N m]
  double slope;  // [N m/s]
  double dq0;    // [rad/s]

  double torque(double t) const { return start - slope * t; }
  /// Where I q̈ = τ_h − F brings it to zero.
  double arrives() const {
    const double net = start - kFriction;
    return (net + std::sqrt(net * net + 2.0 * slope * kInertia * dq0)) / slope;
  }
  /// Where τ_h overcomes −F.
  double leaves() const { return std::max(arrives(), (start + kFriction) / slope); }
  double positionWhileTurning(double t) const {
    return dq0 * t + (0.5 * (start - kFriction) * t * t - slope * t * t * t / 6.0) / kInertia;
  }
  double position(double t) const {
    if (t <= arrives()) return positionWhileTurning(t);
    const double back = std::max(0.0, t - leaves());
    const double net = torque(leaves()) + kFriction;
    return positionWhileTurning(arrives()) + (0.5 * net * back * back - slope * back * back * back / 6.0) / kInertia;
  }
};

/// At 1 kHz by an encoder of 2^-18 revolutions; the motor rests.
Demonstration record(const Pull& pull, double duration, double phase = 0.0) {
  Demonstration demonstration;
  demonstration.columns = {{"q_turn", "rad", Role::state, Interpolation::linear, ""},
                           {"tau_turn", "N m", Role::state, Interpolation::linear, ""}};
  const auto rows = static_cast<Index>(1000.0 * duration);
  demonstration.values = Eigen::MatrixXd::Zero(rows, 2);
  for (Index k = 0; k < rows; ++k) {
    const double t = 1e-3 * static_cast<double>(k);
    demonstration.time.push_back(t);
    demonstration.values(k, 0) = kEncoderStep * std::round((pull.position(t) + phase) / kEncoderStep);
  }
  demonstration.metadata.effort.timing = "held";
  demonstration.metadata.effort.control_period = 1e-3;
  return demonstration;
}

Eigen::VectorXd column(const Demonstration& demonstration, const std::string& name) {
  for (std::size_t i = 0; i < demonstration.columns.size(); ++i) {
    if (demonstration.columns[i].name == name) return demonstration.values.col(static_cast<Index>(i));
  }
  ADD_FAILURE() << "no column " << name;
  return {};
}

/// Root mean square error of the torque [N m] within [from, to].
double errorOf(const Demonstration& result, const Pull& pull, double from, double to) {
  const Eigen::VectorXd torque = column(result, "tau_h_turn");
  double squares = 0.0;
  double count = 0.0;
  for (Index k = 0; k < torque.size(); ++k) {
    const double t = result.time[static_cast<std::size_t>(k)];
    if (t < from || t > to) continue;
    squares += std::pow(torque[k] - pull.torque(t), 2);
    count += 1.0;
  }
  return std::sqrt(squares / count);
}

TEST(HoldingFrictionTest, WhereAJointTurnsRoundItsAccelerationJumpsAndTheTorqueDoesNot) {
  const Pull pull{-0.5, 0.3, 20.0};  // τ_h is below −F when it arrives: it does not stand
  ASSERT_EQ(pull.leaves(), pull.arrives());
  Demonstration result = record(pull, 1.6);
  const SmoothedMotion without = smoothMotion(result.time, column(result, "q_turn"));
  addHumanTorque(turntable(kFriction), result);
  const double turns = pull.arrives();
  double worst = 0.0;
  for (Index k = 0; k < without.acceleration.size(); ++k) {
    const double t = result.time[static_cast<std::size_t>(k)];
    if (t < turns - 0.05 || t > turns - 0.001) continue;
    worst = std::max(worst, std::abs(kInertia * without.acceleration[k] + kFriction - pull.torque(t)));
  }
  EXPECT_GT(worst, 0.5 * kFriction) << "[N m] were the acceleration taken for a continuous one";
  EXPECT_LT(errorOf(result, pull, turns - 0.1, turns + 0.1), 0.2 * kFriction) << "its sign is in doubt for some ms";
  EXPECT_LT(errorOf(result, pull, turns - 0.1, turns - 0.005), 0.05 * kFriction);
  EXPECT_LT(errorOf(result, pull, turns + 0.005, turns + 0.1), 0.05 * kFriction);
}

TEST(HoldingFrictionTest, TheTorqueOfAJointThatComesToAStandAndBreaksLooseIsWithinWhatIsSaid) {
  for (const double phase : {0.0, 0.2 * kEncoderStep, 0.4 * kEncoderStep, 0.7 * kEncoderStep}) {
    const Pull pull{0.2, 1.2, 2.0};  // arrives at 0.39 s with −0.27 N m and stands until 0.5 s
    ASSERT_GT(pull.leaves(), pull.arrives() + 0.05);
    Demonstration result = record(pull, 1.0, phase);
    addHumanTorque(turntable(kFriction), result);
    const Eigen::VectorXd torque = column(result, "tau_h_turn");
    const Eigen::VectorXd deviation = column(result, "tau_h_std_turn");
    int within = 0;
    for (Index k = 0; k < torque.size(); ++k) {
      const double t = result.time[static_cast<std::size_t>(k)];
      if (std::abs(torque[k] - pull.torque(t)) < 2.0 * deviation[k]) ++within;
    }
    EXPECT_GT(within, 0.93 * static_cast<double>(torque.size()));
    EXPECT_LT(errorOf(result, pull, pull.arrives() - 0.1, pull.arrives() - 0.002), 0.1 * kFriction);
    const auto middle = static_cast<Index>(1000.0 * 0.5 * (pull.arrives() + pull.leaves()));
    EXPECT_NEAR(deviation[middle], kFriction / std::sqrt(3.0), 0.1 * kFriction) << "anything from −F to F";
  }
}

TEST(HoldingFrictionTest, ASensorBehindTheFrictionJumpsWithTheAccelerationSoThatBothMayBeSmoothedAlike) {
  const Pull pull{0.2, 1.2, 2.0};
  Demonstration result = record(pull, 1.0);
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.01);
  for (Index k = 0; k < result.values.rows(); ++k) {
    const double t = 1e-3 * static_cast<double>(k);
    const double friction = t < pull.arrives() ? kFriction : t < pull.leaves() ? pull.torque(t) : -kFriction;
    result.values(k, 1) = noise(random) - friction;
  }
  result.metadata.effort.side = "link";
  result.metadata.effort.timing = "instant";
  Demonstration blind = result;
  addHumanTorque(turntable(kFriction), result);
  addHumanTorque(turntable(0.0), blind);
  EXPECT_EQ(column(result, "tau_h_turn"), column(blind, "tau_h_turn"));
  const double from = pull.arrives() - 0.05;
  const double to = pull.arrives() + 0.05;
  EXPECT_LT(errorOf(result, pull, from, to), 0.02 * kFriction);
}

TEST(HoldingFrictionTest, AJointThatStandsHidesWhatItsFrictionHolds) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 1e-5);
  for (const double friction_velocity : {0.0, 0.01}) {
    RobotDescription arm = turntable(kFriction);
    arm.joints[0].friction_velocity = friction_velocity;
    Demonstration result = record({0.0, 0.0, 0.0}, 0.001);
    result.time.clear();
    result.values.resize(2000, 2);
    for (Index k = 0; k < 2000; ++k) {
      result.time.push_back(1e-3 * static_cast<double>(k));
      result.values.row(k) << 0.3 + noise(random), 0.0;
    }
    addHumanTorque(arm, result);
    const Eigen::VectorXd torque = column(result, "tau_h_turn");
    const Eigen::VectorXd deviation = column(result, "tau_h_std_turn");
    for (const double truth : {-0.9 * kFriction, 0.0, 0.5 * kFriction}) {
      const Eigen::ArrayXd error = (torque.array() - truth).abs() / deviation.array();
      EXPECT_GT((error < 2.0).cast<double>().mean(), 0.99) << truth << " N m, friction velocity " << friction_velocity;
    }
    EXPECT_LT(deviation.segment(100, 1800).maxCoeff(), 1.1 * kFriction) << "nor does it hide more";
  }
}

TEST(HoldingFrictionTest, WithoutFrictionTheAccelerationIsTheSmoothersToTheLastBit) {
  Demonstration result = record({-0.5, 0.3, 20.0}, 1.6);
  const SmoothedMotion motion = smoothMotion(result.time, column(result, "q_turn"));
  addHumanTorque(turntable(0.0), result);
  EXPECT_EQ(column(result, "ddq_turn"), motion.acceleration);
  EXPECT_EQ(column(result, "dq_turn"), motion.velocity);
}

}  // namespace
}  // namespace demo_logger
