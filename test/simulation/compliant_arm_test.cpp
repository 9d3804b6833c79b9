// The arm that a hand guides: the equations that the hand feels, how a mode takes over, limits.

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <functional>
#include <limits>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/simulation/compliance.h"
#include "demo_logger/simulation/simulated_arm.h"
#include "demo_logger/trajectory/error.h"
#include "test/simulation/arms.h"

namespace demo_logger {
namespace {

constexpr Nanoseconds kStart = kNanosecondsPerSecond;

Eigen::VectorXd seven(double value) { return Eigen::VectorXd::Constant(7, value); }

/// And without limits, as nothing but the equation shall shape its motion.
RobotDescription frictionless() {
  RobotDescription arm = describeDemoArm();
  for (ArmJoint& joint : arm.joints) {
    joint.damping = joint.friction = 0.0;
    joint.velocity_limit = joint.upper = std::numeric_limits<double>::infinity();
    joint.lower = -joint.upper;
  }
  return arm;
}

const TipWrench kPush{{3.0, 4.0, -2.0}, {0.02, -0.03, 0.001}};  // [N, N m] base axes

LinkWrench atTip(const RobotDescription& arm, const TipWrench& wrench) {
  return {6, arm.X_lastlink_tip.translation(), wrench.force, wrench.torque, false};
}

Eigen::VectorXd stacked(const TipWrench& wrench) {
  Eigen::VectorXd values(6);
  values << wrench.force, wrench.torque;
  return values;
}

using Acceleration = std::function<Eigen::VectorXd(const ArmState&)>;

/// After `duration` [s], by the classical Runge-Kutta method.
ArmState integrated(ArmState state, const Acceleration& acceleration, double duration, int steps) {
  const double h = duration / steps;
  for (int k = 0; k < steps; ++k) {
    const auto moved = [&](const Eigen::VectorXd& dq, const Eigen::VectorXd& ddq, double time) {
      return ArmState{state.q + time * dq, state.dq + time * ddq};
    };
    const Eigen::VectorXd a1 = acceleration(state);
    const ArmState s2 = moved(state.dq, a1, h / 2.0);
    const Eigen::VectorXd a2 = acceleration(s2);
    const ArmState s3 = moved(s2.dq, a2, h / 2.0);
    const Eigen::VectorXd a3 = acceleration(s3);
    const ArmState s4 = moved(s3.dq, a3, h);
    const Eigen::VectorXd a4 = acceleration(s4);
    state = moved((state.dq + 2.0 * s2.dq + 2.0 * s3.dq + s4.dq) / 6.0, (a1 + 2.0 * a2 + 2.0 * a3 + a4) / 6.0, h);
  }
  return state;
}

/// What the hand is to feel: M q̈ + C q̇ + K_p (q − q_ref) + K_d q̇ = Jᵀ W, by KDL alone.
class FeltArm {
 public:
  FeltArm(const RobotDescription& arm, ImpedanceGains gains, Eigen::VectorXd q_ref)
      : model_(arm), gains_(std::move(gains)), q_ref_(std::move(q_ref)) {}

  Eigen::VectorXd acceleration(const ArmState& state, const TipWrench& wrench) const {
    return model_.massMatrix(state.q).llt().solve(humanTorque(state, wrench) - resistance(state));
  }

  /// Left side minus right side [N m].
  Eigen::VectorXd residual(const ArmState& state, const Eigen::VectorXd& ddq, const TipWrench& wrench) const {
    return model_.massMatrix(state.q) * ddq + resistance(state) - humanTorque(state, wrench);
  }

 private:
  Eigen::VectorXd humanTorque(const ArmState& state, const TipWrench& wrench) const {
    return model_.jacobian(state.q).transpose() * stacked(wrench);
  }
  Eigen::VectorXd resistance(const ArmState& state) const {
    return model_.coriolis(state.q, state.dq) + gains_.stiffness.cwiseProduct(state.q - q_ref_) +
           gains_.damping.cwiseProduct(state.dq);
  }

  RobotModel model_;
  ImpedanceGains gains_;
  Eigen::VectorXd q_ref_;
};

struct Case {
  ControlMode mode;
  ImpedanceGains gains;
};

std::vector<Case> cases() {
  return {{ControlMode::gravity_compensation, {seven(0.0), seven(0.0)}},
          {ControlMode::impedance, defaultImpedanceGains(describeDemoArm(), /*control_period=*/4e-3)}};
}

SimulatedArm referenceArm(const Case& a_case, double period) {
  SimulatedArmConfiguration configuration = makeArmConfiguration(a_case.mode);
  configuration.integrator = Integrator::runge_kutta_4;
  configuration.controller.control_period = period;
  configuration.controller.impedance = a_case.gains;
  return {frictionless(), configuration};
}

constexpr double kDuration = 0.5;  // [s]

/// How far the simulated arm is from what is to be felt [rad], pushed for kDuration.
double errorAtPeriod(const Case& a_case, double period) {
  SimulatedArm arm = referenceArm(a_case, period);
  arm.applyWrench(atTip(arm.description(), kPush), kStart + 2 * kNanosecondsPerSecond);
  const auto ticks = static_cast<int>(std::lround(kDuration / period));
  ArmTick tick;
  for (int k = 0; k <= ticks; ++k) {
    tick = arm.tick(kStart + fromSeconds(k * period), {});
    if (tick.applied.reason.empty()) continue;
    ADD_FAILURE() << tick.applied.reason << " at tick " << k;
    return NAN;
  }
  const std::vector<double> start = bentPosition();
  const Eigen::VectorXd q = Eigen::Map<const Eigen::VectorXd>(start.data(), 7);
  const FeltArm felt(frictionless(), a_case.gains, q);
  const ArmState exact = integrated(
      {q, seven(0.0)}, [&](const ArmState& state) { return felt.acceleration(state, kPush); }, kDuration, 1000);
  EXPECT_GT((exact.q - q).norm(), 0.1) << "[rad], it does move";
  return (tick.truth.q - exact.q).norm();
}

TEST(CompliantArmTest, FeelsAsTheEquationSaysAndTheErrorHalvesWithTheControlPeriod) {
  for (const Case& a_case : cases()) {
    const double coarse = errorAtPeriod(a_case, 2e-3);
    const double usual = errorAtPeriod(a_case, 1e-3);
    const double fine = errorAtPeriod(a_case, 5e-4);
    EXPECT_NEAR(coarse / usual, 2.0, 0.1) << toString(a_case.mode);
    EXPECT_NEAR(usual / fine, 2.0, 0.05) << toString(a_case.mode);
    EXPECT_LT(usual, 0.02) << "[rad] at 1 kHz, wrists at some 5 rad/s: the torque acts half a period late";
  }
}

TEST(CompliantArmTest, WithTheTorqueHeldItGoesAsAnIndependentIntegrationDoes) {
  for (const Case& a_case : cases()) {
    SimulatedArm arm = referenceArm(a_case, 1e-3);
    arm.applyWrench(atTip(arm.description(), kPush), kStart + 2 * kNanosecondsPerSecond);
    const RobotModel model(frictionless());
    ArmTick tick = arm.tick(kStart, {});
    const Eigen::VectorXd q_ref = tick.truth.q;
    ArmState state = tick.truth;
    for (int k = 1; k <= 500; ++k) {
      const Eigen::VectorXd held = model.gravity(state.q) - a_case.gains.stiffness.cwiseProduct(state.q - q_ref) -
                                   a_case.gains.damping.cwiseProduct(state.dq);
      const auto acceleration = [&](const ArmState& s) -> Eigen::VectorXd {
        const Eigen::VectorXd push = model.jacobian(s.q).transpose() * stacked(kPush);
        return model.massMatrix(s.q).llt().solve(held + push - model.coriolis(s.q, s.dq) - model.gravity(s.q));
      };
      state = integrated(state, acceleration, 1e-3, 4);
      tick = arm.tick(kStart + k * kMillisecond, {});
    }
    EXPECT_LT((tick.truth.q - state.q).norm(), 1e-9) << "[rad] " << toString(a_case.mode);
    EXPECT_LT((tick.truth.dq - state.dq).norm(), 1e-8) << "[rad/s]";
  }
}

TEST(CompliantArmTest, ObeysTheEquationAtEachTickToRounding) {
  for (const Case& a_case : cases()) {
    SimulatedArm arm = referenceArm(a_case, 1e-3);
    BulletArm physics(frictionless(), {}, Integrator::runge_kutta_4);
    const LinkWrench push = atTip(arm.description(), kPush);
    arm.applyWrench(push, kStart + 300 * kMillisecond);
    const std::vector<double> start = bentPosition();
    const FeltArm felt(frictionless(), a_case.gains, Eigen::Map<const Eigen::VectorXd>(start.data(), 7));
    for (int k = 0; k < 600; ++k) {
      const ArmTick tick = arm.tick(kStart + k * kMillisecond, {});
      ASSERT_EQ(tick.applied.reason, "") << "tick " << k;
      physics.reset(tick.truth);
      const Eigen::VectorXd ddq = physics.acceleration(tick.applied.torque + tick.external_torque);
      const TipWrench wrench = k < 300 ? kPush : TipWrench{};
      ASSERT_LT(felt.residual(tick.truth, ddq, wrench).cwiseAbs().maxCoeff(), 1e-10) << "[N m] at tick " << k;
    }
  }
}

TEST(CompliantArmTest, StaysWhereItIsPutOrSpringsBack) {
  for (const Case& a_case : cases()) {
    SimulatedArm arm = referenceArm(a_case, 1e-3);
    const Eigen::VectorXd start = arm.tick(kStart, {}).truth.q;
    arm.applyWrench(atTip(arm.description(), kPush), kStart + 500 * kMillisecond);
    double farthest = 0.0;
    for (int k = 1; k < 12000; ++k) {
      farthest = std::max(farthest, (arm.tick(kStart + k * kMillisecond, {}).truth.q - start).norm());
    }
    const ArmTick late = arm.tick(kStart + 12000 * kMillisecond, {});
    if (a_case.mode == ControlMode::impedance) {
      EXPECT_LT((late.truth.q - start).norm(), 0.02 * farthest) << "[rad]";
      EXPECT_EQ(late.applied.command, start) << "where its springs rest";
      EXPECT_EQ(late.applied.names, arm.description().jointNames());
    } else {
      EXPECT_EQ(late.applied.command.size(), 0);
      EXPECT_TRUE(late.applied.names.empty());
    }
  }
}

TEST(CompliantArmTest, NoCommandIsMissedHowLongItTakes) {
  for (const ControlMode mode : {ControlMode::gravity_compensation, ControlMode::impedance}) {
    SimulatedArm arm = makeDemoArm(mode);
    for (int k = 0; k < 3000; ++k) {
      ASSERT_EQ(arm.tick(kStart + k * kMillisecond, {}).applied.reason, "") << "command_timeout is 0.5 s";
    }
    ArmCommand command;
    command.mode = ControlMode::velocity;
    command.values = seven(0.1);
    const ArmTick tick = arm.tick(kStart + 3000 * kMillisecond, {command});
    EXPECT_EQ(tick.applied.reason,
              "refused: a command for mode velocity came while mode " + toString(mode) + " is in force");
    EXPECT_EQ(arm.refused(), 1U);
  }
}

using Commands = std::function<std::vector<ArmCommand>(int)>;

struct Switch {
  ArmTick before;
  ArmTick after;
  std::vector<ArmTick> later;
};

Switch switchMode(SimulatedArm& arm, const Commands& commands, int at, const std::function<void()>& switch_mode) {
  Switch result;
  for (int k = 0; k < at; ++k) result.before = arm.tick(kStart + k * kMillisecond, commands(k));
  switch_mode();
  result.after = arm.tick(kStart + at * kMillisecond, {});
  for (int k = at + 1; k < at + 300; ++k) result.later.push_back(arm.tick(kStart + k * kMillisecond, {}));
  return result;
}

ArmCommand commandOf(ControlMode mode, const Eigen::VectorXd& values) {
  ArmCommand command;
  command.mode = mode;
  command.values = values;
  return command;
}

TEST(CompliantArmTest, AtRestTheSwitchChangesNoTorqueButByRounding) {
  for (const ControlMode old_mode : {ControlMode::velocity, ControlMode::cartesian_velocity, ControlMode::position}) {
    for (const ControlMode mode : {ControlMode::gravity_compensation, ControlMode::impedance}) {
      SimulatedArm arm = makeDemoArm(old_mode);
      const Switch switched = switchMode(
          arm, [](int) { return std::vector<ArmCommand>(); }, 500, [&] { arm.setMode(mode); });
      EXPECT_LT((switched.after.applied.torque - switched.before.applied.torque).cwiseAbs().maxCoeff(), 1e-9);
      EXPECT_LT((switched.later.back().truth.q - switched.before.truth.q).cwiseAbs().maxCoeff(), 1e-9) << "[rad]";
    }
  }
}

TEST(CompliantArmTest, InMotionTheMotorsGoOnFromTheirLastTorque) {
  Eigen::VectorXd twist = Eigen::VectorXd::Zero(6);
  twist << 0.05, 0.2, 0.1, 0.2, 0.0, 0.3;
  const std::vector<std::pair<ControlMode, ArmCommand>> drives{
      {ControlMode::cartesian_velocity, commandOf(ControlMode::cartesian_velocity, twist)},
      {ControlMode::velocity, commandOf(ControlMode::velocity, seven(0.4))},
      {ControlMode::effort, commandOf(ControlMode::effort, (Eigen::VectorXd(7) << 8, -6, 4, 3, 1, 1, 0.3).finished())}};
  for (const auto& [old_mode, command] : drives) {
    for (const ControlMode mode : {ControlMode::gravity_compensation, ControlMode::impedance}) {
      SimulatedArm arm = makeDemoArm(old_mode);
      const Switch switched = switchMode(
          arm, [&, sent = command](int) { return std::vector<ArmCommand>{sent}; }, 150, [&] { arm.setMode(mode); });
      EXPECT_GT(switched.before.truth.dq.norm(), 0.1) << "[rad/s] " << toString(old_mode);
      EXPECT_LT((switched.after.applied.torque - switched.before.applied.torque).cwiseAbs().maxCoeff(), 1e-9)
          << toString(old_mode) << " to " << toString(mode);
      // And from there on the new law comes in without haste.
      Eigen::VectorXd last = switched.after.applied.torque;
      for (const ArmTick& tick : switched.later) {
        EXPECT_LT((tick.applied.torque - last).cwiseAbs().maxCoeff(), 0.5) << "[N m] in a tick";
        last = tick.applied.torque;
      }
      if (mode == ControlMode::gravity_compensation) {
        const Eigen::VectorXd gravity = RobotModel(describeDemoArm()).gravity(switched.later.back().truth.q);
        EXPECT_LT((last - gravity).cwiseAbs().maxCoeff(), 1e-12) << "after the take-over the law is all there is";
      } else {
        EXPECT_EQ(switched.later.back().applied.command, switched.after.truth.q) << "q_ref is where it was switched";
      }
    }
  }
}

TEST(CompliantArmTest, AStretchedSpringIsLetGoWithoutAJump) {
  SimulatedArm arm = makeDemoArm(ControlMode::impedance);
  arm.applyWrench(atTip(arm.description(), kPush), kStart + 2 * kNanosecondsPerSecond);
  const Switch switched = switchMode(
      arm, [](int) { return std::vector<ArmCommand>(); }, 400,
      [&] {
        arm.setMode(ControlMode::impedance, {seven(10.0), seven(0.1)});
      });
  EXPECT_LT((switched.after.applied.torque - switched.before.applied.torque).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(switched.after.applied.command, switched.after.truth.q) << "q_ref is taken anew";
}

TEST(CompliantArmTest, AResetArmRestsWhereItWasPut) {
  SimulatedArm arm = makeDemoArm(ControlMode::impedance);
  arm.applyWrench(atTip(arm.description(), kPush), kStart + 400 * kMillisecond);
  for (int k = 0; k < 400; ++k) arm.tick(kStart + k * kMillisecond, {});
  arm.setMode(ControlMode::impedance);
  arm.tick(kStart + 400 * kMillisecond, {});
  arm.reset();
  const ArmTick tick = arm.tick(kStart + 401 * kMillisecond, {});
  EXPECT_EQ(tick.applied.command, tick.truth.q);
  EXPECT_EQ(tick.applied.torque, RobotModel(describeDemoArm()).gravity(tick.truth.q));
}

TEST(CompliantArmTest, MotorsAreCutOffAtTheirLimitsAndSayWhy) {
  SimulatedArm arm = makeDemoArm(ControlMode::impedance);
  arm.setMode(ControlMode::impedance, {seven(3000.0), seven(1.2)});
  arm.tick(kStart, {});
  TipWrench hard;
  hard.force = {0.0, 300.0, 0.0};
  arm.applyWrench(atTip(arm.description(), hard), kStart + kNanosecondsPerSecond);
  bool said = false;
  for (int k = 1; k < 1000; ++k) {
    const ArmTick tick = arm.tick(kStart + k * kMillisecond, {});
    for (std::size_t i = 0; i < 7; ++i) {
      ASSERT_LE(std::abs(tick.applied.torque[static_cast<Eigen::Index>(i)]), arm.description().joints[i].effort_limit);
    }
    said = said || tick.applied.reason.find("effort of joint_7 limited to 40 N m") != std::string::npos;
  }
  EXPECT_TRUE(said);
}

TEST(CompliantArmTest, AHandThatPushesIntoALimitIsMetBeforeTheStop) {
  SimulatedArm arm = makeDemoArm(ControlMode::gravity_compensation);
  const ArmJoint& elbow = arm.description().joints[3];
  bool said = false;
  double farthest = 0.0;
  for (int k = 0; k < 4000; ++k) {
    const ArmTick tick = arm.tick(kStart + k * kMillisecond, {});
    arm.applyWrench({3, {0.0, 0.0, 0.0}, {}, 12.0 * elbow.axis, true}, kStart + (k + 2) * kMillisecond, "/hand");
    said = said || tick.applied.reason.find("joint_4 braked before its position limit") != std::string::npos;
    farthest = std::max(farthest, std::abs(tick.truth.q[3]));
  }
  EXPECT_TRUE(said);
  EXPECT_GT(farthest, 2.0) << "[rad], it was pushed there";
  EXPECT_LE(farthest, elbow.upper + 0.005);
}

TEST(CompliantArmTest, UnstableGainsOfTheConfigurationStopTheArm) {
  SimulatedArmConfiguration configuration = makeArmConfiguration(ControlMode::impedance);
  configuration.controller.impedance = {seven(100.0), seven(100.0)};
  try {
    const SimulatedArm arm(describeDemoArm(), configuration);
    FAIL() << "taken";
  } catch (const ConfigurationError& error) {
    EXPECT_EQ(std::string(error.what()).rfind("impedance: damping of joint_7 is 100 N m s/rad, expected at most ", 0),
              0U)
        << error.what();
  }
}

}  // namespace
}  // namespace demo_logger
