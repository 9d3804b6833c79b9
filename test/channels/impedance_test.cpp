#include "demo_logger/channels/impedance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace demo_logger {
namespace {

Eigen::VectorXd one(double value) { return Eigen::VectorXd::Constant(1, value); }

/// Largest |δ| that a loop of one joint reaches late, simulated period by period.
double lateAmplitude(double inertia, double stiffness, double damping, double h) {
  double q = 1.0;
  double dq = 0.0;
  double largest = 0.0;
  for (int k = 0; k < 20000; ++k) {
    const double a = -(stiffness * q + damping * dq) / inertia;
    q += h * dq + 0.5 * h * h * a;
    dq += h * a;
    if (k > 19000) largest = std::max(largest, std::abs(q));
  }
  return largest;
}

TEST(ImpedanceTest, WithoutStiffnessAndDampingItIsGravityCompensation) {
  const ImpedanceGains none{one(0.0), one(0.0)};
  EXPECT_EQ(impedanceTorque(none, one(7.0), one(1.2), one(3.0), one(0.0), one(100.0))[0], 7.0);
}

TEST(ImpedanceTest, IsASpringAndADamperAboutTheReferenceCutOffAtTheLimit) {
  const ImpedanceGains gains{one(50.0), one(4.0)};
  EXPECT_DOUBLE_EQ(impedanceTorque(gains, one(7.0), one(0.3), one(0.5), one(0.1), one(100.0))[0],
                   7.0 - 50.0 * 0.2 - 4.0 * 0.5);
  EXPECT_EQ(impedanceTorque(gains, one(7.0), one(3.1), one(0.0), one(0.1), one(20.0))[0], -20.0);
  EXPECT_EQ(impedanceTorque(gains, one(7.0), one(-3.1), one(0.0), one(0.1), one(20.0))[0], 20.0);
}

TEST(ImpedanceTest, AMissingPositionIsNoTorqueToSend) {
  const ImpedanceGains gains{one(50.0), one(4.0)};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(impedanceTorque(gains, one(7.0), one(nan), one(0.5), one(0.1), one(100.0))[0]));
}

TEST(ImpedanceStabilityTest, DampingAloneIsBoundedByOneOverThePeriod) {
  const Eigen::MatrixXd M = one(0.0016);  // a wrist
  const double h = 0.001;
  EXPECT_TRUE(judgeStability({one(0.0), one(1.59)}, M, h).stable);
  EXPECT_FALSE(judgeStability({one(0.0), one(1.61)}, M, h).stable);
  EXPECT_NEAR(judgeStability({one(0.0), one(1.6)}, M, h).damping_rate, 1000.0, 1e-9);
  EXPECT_NEAR(judgeStability({one(0.0), one(4.0)}, M, h).spectral_radius, 1.5, 1e-9) << "|1 - h d|, h d = 2.5";
}

TEST(ImpedanceStabilityTest, AgreesWithASimulatedLoopOnTheWayFromStableToUnstable) {
  const double inertia = 0.02;
  const double h = 0.001;
  // δ'' of the held spring is stable while damping > stiffness h / 2, by the characteristic polynomial.
  const double stiffness = 400.0;
  const double critical = 0.5 * h * stiffness;
  EXPECT_TRUE(judgeStability({one(stiffness), one(1.05 * critical)}, one(inertia), h).stable);
  EXPECT_LT(lateAmplitude(inertia, stiffness, 1.05 * critical, h), 1.0);
  EXPECT_FALSE(judgeStability({one(stiffness), one(0.95 * critical)}, one(inertia), h).stable);
  EXPECT_GT(lateAmplitude(inertia, stiffness, 0.95 * critical, h), 1.0);
}

TEST(ImpedanceStabilityTest, ABoundJointByJointWouldMissWhatTheJointsDoToEachOther) {
  Eigen::MatrixXd M(2, 2);
  M << 1.0, 0.095, 0.095, 0.01;  // (M⁻¹)₂₂ = 1 / (0.01 − 0.009025)
  const double h = 0.001;
  const ImpedanceGains gains{Eigen::Vector2d::Zero(), Eigen::Vector2d(1.0, 5.0)};
  EXPECT_LE(5.0 / M(1, 1), 1.0 / h) << "each joint by itself would pass";
  const ImpedanceStability stability = judgeStability(gains, M, h);
  EXPECT_FALSE(stability.stable);
  EXPECT_GT(stability.damping_rate, 5.0 / (0.01 - 0.009025) - 1e-9)
      << "more than the light joint's effective inertia says";
}

}  // namespace
}  // namespace demo_logger
