#include "demo_logger/channels/momentum_observer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "demo_logger/channels/velocity_filter.h"
#include "demo_logger/trajectory/error.h"

namespace demo_logger {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Eigen::VectorXd one(double value) { return Eigen::VectorXd::Constant(1, value); }

/// A mass on a rail, pushed by a motor and by a constant hand.
struct Cart {
  double mass = 2.0;
  double hand = 3.0;
  double time = 0.0;
  double momentum = 0.5;
  void push(double motor, double dt) {
    momentum += dt * (motor + hand);
    time += dt;
  }
};

TEST(MomentumObserverTest, ApproachesAConstantTorqueAsALowPassOfFirstOrderDoes) {
  const double gain = 50.0;
  const double dt = 1e-4;
  MomentumObserver observer(1, gain);
  Cart cart;
  Eigen::VectorXd torque;
  EXPECT_FALSE(observer.update(0.0, one(cart.momentum), one(0.0), one(0.0), torque));
  int settled = 0;
  for (int k = 0; k < 3000; ++k) {
    const double motor = std::sin(0.01 * k);
    cart.push(motor, dt);
    const bool known = observer.update(dt, one(cart.momentum), one(0.0), one(motor), torque);
    EXPECT_EQ(known, cart.time > 5.0 / gain - 1e-9) << cart.time;
    if (!known) continue;
    ++settled;
    EXPECT_NEAR(torque[0], cart.hand * (1.0 - std::exp(-gain * cart.time)), 1e-3) << cart.time;
  }
  EXPECT_EQ(settled, 2001);
}

TEST(MomentumObserverTest, WhatTheModelExplainsIsNotTheHands) {
  MomentumObserver observer(1, 100.0);
  Eigen::VectorXd torque;
  double momentum = 0.0;
  observer.update(0.0, one(momentum), one(-7.0), one(0.0), torque);
  for (int k = 0; k < 400; ++k) {  // gravity of 7 N m, held by the motor
    ASSERT_NO_THROW(observer.update(0.001, one(momentum), one(-7.0), one(7.0), torque));
  }
  EXPECT_NEAR(torque[0], 0.0, 1e-12);
}

TEST(MomentumObserverTest, UnevenIntervalsChangeNothingOnceSettled) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> interval(0.2e-3, 3e-3);
  MomentumObserver observer(1, 50.0);
  Cart cart;
  Eigen::VectorXd torque;
  observer.update(0.0, one(cart.momentum), one(0.0), one(0.0), torque);
  for (int k = 0; k < 1000; ++k) {
    const double dt = interval(random);
    cart.push(1.0, dt);
    observer.update(dt, one(cart.momentum), one(0.0), one(1.0), torque);
  }
  EXPECT_NEAR(torque[0], cart.hand, 1e-9);
}

TEST(MomentumObserverTest, AGapOrAMissingValueRestartsItAndNothingIsSaidUntilItHasSettled) {
  MomentumObserver observer(1, 50.0);
  Eigen::VectorXd torque;
  const auto run = [&](int samples) {
    bool known = false;
    for (int k = 0; k < samples; ++k) known = observer.update(0.001, one(0.0), one(0.0), one(0.0), torque);
    return known;
  };
  EXPECT_FALSE(run(100));
  EXPECT_TRUE(run(2));
  EXPECT_FALSE(observer.update(0.001, one(kNaN), one(0.0), one(0.0), torque));
  EXPECT_TRUE(std::isnan(torque[0]));
  EXPECT_FALSE(run(100));
  EXPECT_TRUE(run(2));
  EXPECT_FALSE(observer.update(-0.5, one(0.0), one(0.0), one(0.0), torque)) << "the clock went back";
  EXPECT_FALSE(run(90));
  EXPECT_TRUE(run(12));
  observer.restart();
  EXPECT_FALSE(run(1));
}

TEST(MomentumObserverTest, AGainThatMakesNoSenseIsNamed) {
  try {
    MomentumObserver observer(1, 0.0);
    FAIL() << "a gain of zero was accepted";
  } catch (const ConfigurationError& error) {
    EXPECT_STREQ(error.what(), "momentum observer: the gain is 0 1/s, expected a positive number.");
  }
}

TEST(VelocityFilterTest, FollowsARampExactlyOnceSettledAtUnevenStamps) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> interval(0.2e-3, 2e-3);
  VelocityFilter filter(1, 30.0);
  double t = 0.0;
  filter.update(0.0, one(0.0));
  for (int k = 0; k < 1000; ++k) {
    const double dt = interval(random);
    t += dt;
    ASSERT_TRUE(filter.update(dt, one(0.7 * t)));
  }
  EXPECT_NEAR(filter.velocity()[0], 0.7, 1e-9);
}

TEST(VelocityFilterTest, AnswersAStepOfVelocityAsButterworthDoes) {
  const double omega = 2.0 * kPi * 30.0;
  const double a = omega / std::sqrt(2.0);
  VelocityFilter filter(1, 30.0);
  EXPECT_FALSE(filter.update(0.0, one(0.0))) << "one position says nothing of velocity";
  EXPECT_TRUE(filter.update(0.001, one(0.0)));
  for (int k = 1; k <= 100; ++k) {
    filter.update(0.001, one(0.001 * k));
    const double t = 0.001 * k;
    EXPECT_NEAR(filter.velocity()[0], 1.0 - std::exp(-a * t) * (std::cos(a * t) + std::sin(a * t)), 1e-9) << t;
  }
}

TEST(VelocityFilterTest, IsLateByTheDelayItStates) {
  VelocityFilter filter(1, 30.0);
  const double dt = 0.001;
  double largest = 0.0;
  for (int k = 0; k < 4000; ++k) {
    const double t = dt * k;
    filter.update(dt, one(-std::cos(2.0 * kPi * t) / (2.0 * kPi)));
    if (k > 500)
      largest = std::max(largest, std::abs(filter.velocity()[0] - std::sin(2.0 * kPi * (t - filter.delay()))));
  }
  EXPECT_LT(largest, 1e-4) << "a millisecond more or less would be 6e-3";
}

TEST(VelocityFilterTest, SamplesTooRareForItsCutOffGiveNothing) {
  VelocityFilter filter(1, 30.0);
  EXPECT_FALSE(filter.update(0.0, one(0.0)));
  EXPECT_FALSE(filter.update(0.01, one(0.1))) << "100 Hz are less than four times 30 Hz";
  EXPECT_TRUE(filter.update(0.008, one(0.1))) << "the second of a new beginning";
  EXPECT_DOUBLE_EQ(filter.velocity()[0], 0.0);
}

TEST(VelocityFilterTest, KnowsTheVelocityOfAnArmThatMovesAlreadyFromItsSecondSampleOn) {
  VelocityFilter filter(1, 30.0);
  filter.update(0.0, one(5.0));
  for (int k = 1; k <= 50; ++k) {
    ASSERT_TRUE(filter.update(0.001, one(5.0 + 0.0007 * k)));
    EXPECT_NEAR(filter.velocity()[0], 0.7, 1e-9);
  }
}

}  // namespace
}  // namespace demo_logger
