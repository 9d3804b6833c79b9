// The simulated arm against motion that is known in closed form, or that an independent integrator finds.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "demo_logger/simulation/bullet_arm.h"
#include "test/robot/own_arms.h"
#include "test/robot/two_link_by_hand.h"
#include "test/simulation/simple_arms.h"

namespace demo_logger {
namespace {

/// Mean period [s] of 20 swings from rest at `amplitude`, by the straight line between the samples around each upward
/// crossing of the bottom, where the motion has no curvature.
double measuredPeriod(double amplitude, double step) {
  BulletArm arm(makePendulum(9.81));
  arm.reset({vector1(amplitude), vector1(0.0)});
  double first = 0.0, last = 0.0;
  int crossings = 0;
  for (int tick = 1; crossings < 21; ++tick) {
    const double before = arm.state().q[0];
    arm.step(vector1(0.0), step, 1);
    const double after = arm.state().q[0];
    if (!(before < 0.0 && after >= 0.0)) continue;
    last = (tick - after / (after - before)) * step;
    if (crossings++ == 0) first = last;
  }
  return (last - first) / 20.0;
}

/// T = 4 √(l/g) K(sin(θ₀/2)). Semi-implicit Euler has the frequency error of leapfrog, (ω h)²/24 relative for small
/// swings; twice that is allowed here for large ones.
TEST(PendulumTest, SwingsWithThePeriodOfTheEllipticIntegral) {
  for (const double step : {0.25e-3, 1e-3}) {
    for (const double amplitude : {0.1, 1.0, 2.0}) {
      const double exact = 4.0 * std::sqrt(1.0 / 9.81) * std::comp_ellint_1(std::sin(amplitude / 2.0));
      const double tolerance = 9.81 * step * step / 12.0;
      EXPECT_NEAR(measuredPeriod(amplitude, step) / exact, 1.0, tolerance) << amplitude << " rad, " << step << " s";
    }
  }
}

/// Runge-Kutta of fourth order on the closed form of the two-link arm.
ArmState twoLinkByRungeKutta(ArmState state, double duration) {
  using Vector4 = Eigen::Vector4d;
  const auto rate = [](const Vector4& x) -> Vector4 {
    const Eigen::Vector2d q = x.head<2>(), dq = x.tail<2>();
    Vector4 dx;
    dx << dq, TwoLinkByHand::mass(q).inverse() * (-TwoLinkByHand::coriolis(q, dq) - TwoLinkByHand::gravity(q));
    return dx;
  };
  constexpr double h = 1e-4;
  Vector4 x;
  x << state.q, state.dq;
  for (int step = 0; step < std::lround(duration / h); ++step) {
    const Vector4 k1 = rate(x), k2 = rate(x + 0.5 * h * k1), k3 = rate(x + 0.5 * h * k2), k4 = rate(x + h * k3);
    x += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  return {x.head<2>(), x.tail<2>()};
}

ArmState twoLinkByBullet(const ArmState& start, double duration, int substeps_per_ms) {
  BulletArm arm(describeOwnArm("two_link"));
  arm.reset(start);
  for (int tick = 0; tick < std::lround(duration / 1e-3); ++tick) {
    arm.step(Eigen::VectorXd::Zero(2), 1e-3, substeps_per_ms);
  }
  return arm.state();
}

TEST(PendulumTest, TheTwoLinkArmFallsAsItsClosedFormSaysBetterWithEveryHalvingOfTheStep) {
  const ArmState start{Eigen::Vector2d(2.6, 0.5), Eigen::Vector2d(0.0, 0.0)};
  const ArmState exact = twoLinkByRungeKutta(start, 1.0);
  const double error = (twoLinkByBullet(start, 1.0, 4).q - exact.q).norm();
  const double half_step_error = (twoLinkByBullet(start, 1.0, 8).q - exact.q).norm();
  EXPECT_LT(error, 2e-3);
  EXPECT_NEAR(error / half_step_error, 2.0, 0.1) << "a method of first order: nothing but the step errs";
}

TEST(PendulumTest, AFallingTwoLinkArmKeepsItsEnergyUpToTheStep) {
  const Eigen::Vector2d q(1.2, -0.8);
  const double energy = TwoLinkByHand::energy(q, Eigen::Vector2d::Zero());
  double worst[2] = {0.0, 0.0};
  for (const int refined : {0, 1}) {
    BulletArm arm(describeOwnArm("two_link"));
    arm.reset({q, Eigen::Vector2d::Zero()});
    for (int tick = 0; tick < 1000; ++tick) {
      arm.step(Eigen::VectorXd::Zero(2), 1e-3, refined == 0 ? 4 : 8);
      worst[refined] =
          std::max(worst[refined], std::abs(TwoLinkByHand::energy(arm.state().q, arm.state().dq) - energy));
    }
  }
  EXPECT_LT(worst[0], 0.01 * 4.0 * 9.81) << "1 % of what there is to fall";
  EXPECT_NEAR(worst[0] / worst[1], 2.0, 0.2) << "first order in the step";
}

}  // namespace
}  // namespace demo_logger
