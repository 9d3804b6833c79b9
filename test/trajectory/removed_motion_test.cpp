// Deviations where the motion is not the random snap that the smoother takes it for.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>

#include "demo_logger/trajectory/motion_smoother.h"

namespace demo_logger {
namespace {

using Index = Eigen::Index;

constexpr double kPi = 3.14159265358979323846;

struct Truth {
  std::vector<double> time;
  Eigen::VectorXd velocity, acceleration;
  Eigen::VectorXd measured;  // position with noise
};

/// Minimum-jerk reaches of half a second to two seconds, one after the other, and three sines of tremor on top from
/// `tremor_from` on.
struct HandMotion {
  double rate = 1000.0;      // [Hz]
  double noise = 1e-3;       // [rad], normal
  double tremor = 2e-4;      // [rad] amplitude of each sine
  double tremor_from = 0.0;  // [s]
  double duration = 12.0;    // [s]
  double jitter = 0.0;       // of the sampling interval
  unsigned seed = 1;
};

Truth move(const HandMotion& hand) {
  std::mt19937 random(hand.seed);
  std::normal_distribution<double> normal(0.0, hand.noise);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const auto count = static_cast<Index>(hand.duration * hand.rate);
  Truth truth{{}, Eigen::VectorXd(count), Eigen::VectorXd(count), Eigen::VectorXd(count)};
  const double phases[] = {2.0 * kPi * uniform(random), 2.0 * kPi * uniform(random), 2.0 * kPi * uniform(random)};
  double start = 0.3;
  double duration = 1.0;
  double from = 0.0;
  double to = 0.5;
  for (Index k = 0; k < count; ++k) {
    const double t = (static_cast<double>(k) + hand.jitter * uniform(random)) / hand.rate;
    if (t > start + duration) {
      start += duration;
      duration = 0.5 + 1.5 * uniform(random);
      from = to;
      to = 1.5 * (uniform(random) - 0.5);
    }
    const double s = std::clamp((t - start) / duration, 0.0, 1.0);
    double position = from + (to - from) * s * s * s * (10.0 + s * (-15.0 + 6.0 * s));
    truth.velocity[k] = (to - from) / duration * 30.0 * s * s * (1.0 - s) * (1.0 - s);
    truth.acceleration[k] = (to - from) / (duration * duration) * 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s);
    const double frequencies[] = {7.3, 8.9, 10.6};  // [Hz]
    for (int i = 0; i < 3 && t >= hand.tremor_from; ++i) {
      const double w = 2.0 * kPi * frequencies[i];
      position += hand.tremor * std::sin(w * t + phases[i]);
      truth.velocity[k] += hand.tremor * w * std::cos(w * t + phases[i]);
      truth.acceleration[k] -= hand.tremor * w * w * std::sin(w * t + phases[i]);
    }
    truth.time.push_back(t);
    truth.measured[k] = position + normal(random);
  }
  return truth;
}

Eigen::ArrayXd deviations(const SmoothedMotion& motion, Index derivative) {
  Eigen::ArrayXd deviation(static_cast<Index>(motion.covariance.size()));
  for (Index k = 0; k < deviation.size(); ++k) {
    deviation[k] = std::sqrt(motion.covariance[static_cast<std::size_t>(k)](derivative, derivative));
  }
  return deviation;
}

struct Honesty {
  double within;  // [%] two standard deviations
  double ratio;   // root mean square of error over deviation
};

Honesty honestyOf(const Eigen::VectorXd& error, const Eigen::ArrayXd& deviation) {
  const Eigen::ArrayXd relative = error.array() / deviation;
  return {100.0 * (relative.abs() <= 2.0).cast<double>().mean(), std::sqrt(relative.square().mean())};
}

void expectHonest(const HandMotion& hand) {
  const Truth truth = move(hand);
  const SmoothedMotion motion = smoothMotion(truth.time, truth.measured);
  const Honesty velocity = honestyOf(motion.velocity - truth.velocity, deviations(motion, 1));
  const Honesty acceleration = honestyOf(motion.acceleration - truth.acceleration, deviations(motion, 2));
  for (const Honesty& honesty : {velocity, acceleration}) {
    EXPECT_GT(honesty.within, 93.0);
    EXPECT_GT(honesty.ratio, 0.6);
    EXPECT_LT(honesty.ratio, 1.2);
  }
}

TEST(RemovedMotionTest, ATremorTooWeakToBeFollowedIsInTheDeviations) {
  HandMotion hand;
  for (hand.seed = 1; hand.seed <= 3; ++hand.seed) expectHonest(hand);
}

TEST(RemovedMotionTest, ATremorIsInTheDeviationsAtTenTimesFewerUnevenSamplesToo) {
  HandMotion hand;
  hand.rate = 100.0;
  hand.noise = 5e-4;
  hand.tremor = 5e-4;
  hand.jitter = 0.5;
  for (hand.seed = 1; hand.seed <= 3; ++hand.seed) expectHonest(hand);
}

TEST(RemovedMotionTest, WhatATremorAddsStaysWhereItIs) {
  HandMotion hand;
  hand.tremor_from = 6.0;
  const Truth truth = move(hand);
  const SmoothedMotion motion = smoothMotion(truth.time, truth.measured);
  const Eigen::ArrayXd deviation = deviations(motion, 2);
  const Eigen::ArrayXd of_the_model = deviations(smoothMotion(truth.time, truth.measured, motion.time_constant), 2);
  const auto ratio = [&](Index first) {
    Eigen::ArrayXd ratios = deviation.segment(first, 3000) / of_the_model.segment(first, 3000);
    std::nth_element(ratios.data(), ratios.data() + 1500, ratios.data() + 3000);
    return ratios[1500];
  };
  EXPECT_NEAR(ratio(1000), 1.0, 0.1) << "before the tremor, in the middle";
  EXPECT_GT(ratio(8000), 3.0) << "within it";
}

TEST(RemovedMotionTest, WhereTheModelIsRightNothingIsAdded) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  constexpr double kInterval = 0.002;
  constexpr double kNoise = 1e-3;
  constexpr double kTimeConstant = 0.05;
  const double S = kNoise * kNoise * kInterval / std::pow(kTimeConstant, 8);
  std::vector<double> time;
  Eigen::VectorXd measured(10000);
  Eigen::Vector4d x = Eigen::Vector4d::Zero();  // position and its derivatives
  for (Index k = 0; k < measured.size(); ++k) {
    time.push_back(kInterval * static_cast<double>(k));
    measured[k] = x[0] + kNoise * normal(random);
    constexpr int kSteps = 8;
    const double h = kInterval / kSteps;
    for (int step = 0; step < kSteps; ++step) {
      x[3] += std::sqrt(S * h) * normal(random);
      for (int i = 3; i > 0; --i) x[i - 1] += h * x[i];
    }
  }
  const SmoothedMotion motion = smoothMotion(time, measured);
  EXPECT_NEAR(motion.time_constant / kTimeConstant, 1.0, 0.1);
  const SmoothedMotion of_the_model = smoothMotion(time, measured, motion.time_constant);
  for (const Index derivative : {0, 1, 2}) {
    EXPECT_NEAR(deviations(motion, derivative).mean() / deviations(of_the_model, derivative).mean(), 1.0, 0.03);
  }
}

TEST(RemovedMotionTest, TheStepsOfAnEncoderAreNotTakenForMotion) {
  constexpr double kStep = 2.0 * kPi / 262144.0;
  std::vector<double> time;
  Eigen::VectorXd measured(8000);
  for (Index k = 0; k < measured.size(); ++k) {
    time.push_back(0.001 * static_cast<double>(k));
    measured[k] = kStep * std::round(0.005 * std::sin(0.8 * time.back()) / kStep);  // 4 mrad/s: a step each 6 ms
  }
  const SmoothedMotion motion = smoothMotion(time, measured);
  const SmoothedMotion of_the_model = smoothMotion(time, measured, motion.time_constant);
  EXPECT_LT(deviations(motion, 2).maxCoeff(), 1.5 * deviations(of_the_model, 2).maxCoeff());
}

TEST(RemovedMotionTest, ASilenceOfAYearNeedsNoMemory) {
  HandMotion hand;
  hand.duration = 4.0;
  Truth truth = move(hand);
  for (std::size_t k = truth.time.size() / 2; k < truth.time.size(); ++k) truth.time[k] += 3e7;
  const SmoothedMotion motion = smoothMotion(truth.time, truth.measured);
  EXPECT_TRUE(motion.acceleration.allFinite());
  EXPECT_TRUE(deviations(motion, 2).allFinite());
}

TEST(RemovedMotionTest, TheCovarianceStaysOne) {
  const Truth truth = move(HandMotion());
  const SmoothedMotion motion = smoothMotion(truth.time, truth.measured);
  for (const Eigen::Matrix3d& covariance : motion.covariance) {
    const Eigen::Vector3d scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::Matrix3d correlation = scale.asDiagonal() * covariance * scale.asDiagonal();
    ASSERT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(correlation).eigenvalues()[0], 0.0);
    ASSERT_TRUE(covariance.isApprox(covariance.transpose(), 1e-12));
  }
}

}  // namespace
}  // namespace demo_logger
