#include "demo_logger/trajectory/motion_smoother.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <random>

#include "demo_logger/trajectory/error.h"

namespace demo_logger {
namespace {

constexpr double kPi = 3.14159265358979323846;

std::vector<double> irregularTimes(std::size_t count, double interval, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> length(0.3 * interval, 1.7 * interval);
  std::vector<double> time(count);
  double now = 12.0;
  for (double& instant : time) instant = now += length(random);
  return time;
}

/// A hand's reach: minimum jerk from 0 to 1 rad within `duration`, at rest before and after.
struct Reach {
  double start;
  double duration;
  double position(double t) const {
    const double s = std::clamp((t - start) / duration, 0.0, 1.0);
    return s * s * s * (10.0 + s * (-15.0 + 6.0 * s));
  }
  double acceleration(double t) const {
    const double s = (t - start) / duration;
    if (s < 0.0 || s > 1.0) return 0.0;
    return (60.0 * s - 180.0 * s * s + 120.0 * s * s * s) / (duration * duration);
  }
};

std::string messageOf(const std::vector<double>& time, const Eigen::VectorXd& position) {
  try {
    smoothMotion(time, position);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(MotionSmootherTest, ACubicIsFollowedExactlyAtIrregularInstants) {
  const std::vector<double> time = irregularTimes(200, 0.01, 1);
  Eigen::VectorXd position(200);
  for (int k = 0; k < 200; ++k) {
    const double t = time[static_cast<std::size_t>(k)] - 13.0;
    position[k] = 0.3 - 0.7 * t + 2.0 * t * t - 0.5 * t * t * t;
  }
  const SmoothedMotion motion = smoothMotion(time, position, 0.2);
  for (int k = 0; k < 200; ++k) {
    const double t = time[static_cast<std::size_t>(k)] - 13.0;
    EXPECT_NEAR(motion.position[k], position[k], 1e-10);
    EXPECT_NEAR(motion.velocity[k], -0.7 + 4.0 * t - 1.5 * t * t, 1e-8);
    EXPECT_NEAR(motion.acceleration[k], 4.0 - 3.0 * t, 1e-6);
  }
}

/// The same posterior by linear algebra over all samples at once: q = polynomial of degree 3 + ∫∫∫∫ w, whose covariance
/// is S ∫ (t−u)³ (t'−u)³ / 36 du, the polynomial's coefficients being free.
struct Dense {
  Eigen::MatrixXd mean;       // rows: position, velocity, acceleration
  Eigen::MatrixXd deviation;  // ditto
};

double kernel(double a, double b, int da, int db) {
  // ∫_0^min(a,b) (a−u)^(3−da)/(3−da)! (b−u)^(3−db)/(3−db)! du by Gauss and Legendre with 5 points: exact to degree 9
  constexpr double kNodes[] = {0.0, 0.5384693101056831, -0.5384693101056831, 0.9061798459386640, -0.9061798459386640};
  constexpr double kWeights[] = {0.5688888888888889, 0.4786286704993665, 0.4786286704993665, 0.2369268850561891,
                                 0.2369268850561891};
  const auto power = [](double x, int n) { return n == 0 ? 1.0 : n == 1 ? x : n == 2 ? x * x / 2.0 : x * x * x / 6.0; };
  const double end = std::min(a, b);
  double sum = 0.0;
  for (int i = 0; i < 5; ++i) {
    const double u = 0.5 * end * (1.0 + kNodes[i]);
    sum += kWeights[i] * power(a - u, 3 - da) * power(b - u, 3 - db);
  }
  return 0.5 * end * sum;
}

/// What a jump of the acceleration by 1 at `from` adds to a derivative at t.
double ofJump(double t, double from, int derivative) {
  const double s = t - from;
  if (s < 0.0) return 0.0;
  return derivative == 0 ? 0.5 * s * s : derivative == 1 ? s : 1.0;
}

/// `jump`: a sample before which the acceleration jumps, with that variance.
Dense densePosterior(const std::vector<double>& time, const Eigen::VectorXd& z, double S, double r,
                     Eigen::Index jump = 0, double jump_variance = 0.0) {
  const auto n = static_cast<Eigen::Index>(time.size());
  const auto t = [&](Eigen::Index k) { return time[static_cast<std::size_t>(k)] - time.front(); };
  Eigen::MatrixXd K(n, n);
  Eigen::MatrixXd P(n, 4);
  const auto row = [&](Eigen::Index k, int derivative) {
    Eigen::RowVector4d powers = Eigen::RowVector4d::Zero();
    for (int i = derivative; i < 4; ++i) {
      double value = 1.0;
      for (int j = 0; j < i - derivative; ++j) value *= t(k);
      for (int j = 0; j < derivative; ++j) value *= i - j;
      powers[i] = value;
    }
    return powers;
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    P.row(i) = row(i, 0);
    for (Eigen::Index j = 0; j < n; ++j) {
      K(i, j) = S * kernel(t(i), t(j), 0, 0) + jump_variance * ofJump(t(i), t(jump), 0) * ofJump(t(j), t(jump), 0);
    }
  }
  K.diagonal().array() += r;
  const Eigen::LLT<Eigen::MatrixXd> factors(K);
  const Eigen::MatrixXd KinvP = factors.solve(P);
  const Eigen::Matrix4d information = P.transpose() * KinvP;
  const Eigen::Vector4d beta = information.ldlt().solve(KinvP.transpose() * z);
  const Eigen::VectorXd weights = factors.solve(z - P * beta);
  Dense dense{Eigen::MatrixXd(3, n), Eigen::MatrixXd(3, n)};
  for (int d = 0; d < 3; ++d) {
    for (Eigen::Index i = 0; i < n; ++i) {
      Eigen::VectorXd k(n);
      const double jumped = jump_variance * ofJump(t(i), t(jump), d);
      for (Eigen::Index j = 0; j < n; ++j) k[j] = S * kernel(t(i), t(j), d, 0) + jumped * ofJump(t(j), t(jump), 0);
      dense.mean(d, i) = row(i, d) * beta + k.dot(weights);
      const Eigen::Vector4d rest = row(i, d).transpose() - KinvP.transpose() * k;
      dense.deviation(d, i) = std::sqrt(S * kernel(t(i), t(i), d, d) + jumped * ofJump(t(i), t(jump), d) -
                                        k.dot(factors.solve(k)) + rest.dot(information.ldlt().solve(rest)));
    }
  }
  return dense;
}

void expectPosterior(const SmoothedMotion& motion, const Dense& dense) {
  for (Eigen::Index k = 0; k < motion.position.size(); ++k) {
    const Eigen::Matrix3d& covariance = motion.covariance[static_cast<std::size_t>(k)];
    EXPECT_NEAR(motion.position[k], dense.mean(0, k), 1e-3 * dense.deviation(0, k)) << k;
    EXPECT_NEAR(motion.velocity[k], dense.mean(1, k), 1e-3 * dense.deviation(1, k)) << k;
    EXPECT_NEAR(motion.acceleration[k], dense.mean(2, k), 1e-3 * dense.deviation(2, k)) << k;
    for (int d = 0; d < 3; ++d) {
      EXPECT_NEAR(std::sqrt(covariance(d, d)) / dense.deviation(d, k), 1.0, 1e-3) << d << " at " << k;
    }
  }
}

TEST(MotionSmootherTest, AgreesWithThePosteriorByLinearAlgebraOverAllSamples) {
  const std::vector<double> time = irregularTimes(60, 0.02, 2);
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 1e-3);
  Eigen::VectorXd position(60);
  for (int k = 0; k < 60; ++k) position[k] = std::sin(3.0 * time[static_cast<std::size_t>(k)]) + noise(random);
  const SmoothedMotion motion = smoothMotion(time, position, 0.08);
  const double r = motion.measurement_deviation * motion.measurement_deviation;
  const Dense dense = densePosterior(time, position, motion.snap_density, r);
  expectPosterior(motion, dense);
}

TEST(MotionSmootherTest, AJumpAtAKnownInstantIsExactlyAsLinearAlgebraHasIt) {
  const std::vector<double> time = irregularTimes(60, 0.02, 2);
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 1e-3);
  constexpr Eigen::Index kJump = 31;
  constexpr double kVariance = 9.0;  // [rad²/s⁴]
  Eigen::VectorXd position(60);
  for (int k = 0; k < 60; ++k) {
    const double t = time[static_cast<std::size_t>(k)];
    position[k] = std::sin(3.0 * t) + 4.0 * ofJump(t, time[kJump], 0) + noise(random);
  }
  const SmoothedMotion before = smoothMotion(time, position, 0.08);
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(60);
  variance[kJump] = kVariance;
  const SmoothedMotion motion = smoothMotionAgain(time, position, before, variance);
  EXPECT_EQ(motion.time_constant, before.time_constant);
  const Dense dense =
      densePosterior(time, position, motion.snap_density, std::pow(motion.measurement_deviation, 2), kJump, kVariance);
  expectPosterior(motion, dense);
}

TEST(MotionSmootherTest, TheEvidenceOfAJumpIsTheLikelihoodOfOne) {
  const std::vector<double> time = irregularTimes(60, 0.02, 2);
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 1e-3);
  Eigen::VectorXd position(60);
  for (int k = 0; k < 60; ++k) {
    const double t = time[static_cast<std::size_t>(k)];
    position[k] = std::sin(3.0 * t) + 4.0 * ofJump(t, time[31], 0) + noise(random);
  }
  JumpEvidence evidence;
  const SmoothedMotion motion = smoothMotion(time, position, evidence);
  // z ~ N(P β, K), β free: with A = K⁻¹ − K⁻¹ P (Pᵀ K⁻¹ P)⁻¹ Pᵀ K⁻¹ and the jump's effect c, score = cᵀ A z and
  // information = cᵀ A c.
  Eigen::MatrixXd K(60, 60);
  Eigen::MatrixXd P(60, 4);
  const auto t = [&](Eigen::Index k) { return time[static_cast<std::size_t>(k)] - time.front(); };
  for (Eigen::Index i = 0; i < 60; ++i) {
    P.row(i) << 1.0, t(i), t(i) * t(i), std::pow(t(i), 3);
    for (Eigen::Index j = 0; j < 60; ++j) K(i, j) = motion.snap_density * kernel(t(i), t(j), 0, 0);
  }
  K.diagonal().array() += std::pow(motion.measurement_deviation, 2);
  const Eigen::MatrixXd inverse = K.ldlt().solve(Eigen::MatrixXd::Identity(60, 60));
  const Eigen::MatrixXd A = inverse - inverse * P * (P.transpose() * inverse * P).ldlt().solve(P.transpose() * inverse);
  for (const Eigen::Index jump : {20, 31, 45}) {
    Eigen::VectorXd c(60);
    for (Eigen::Index k = 0; k < 60; ++k) c[k] = ofJump(t(k), t(jump), 0);
    EXPECT_NEAR(evidence.score[jump], c.dot(A * position), 1e-3 * std::sqrt(c.dot(A * c))) << jump;
    EXPECT_NEAR(evidence.information[jump] / c.dot(A * c), 1.0, 1e-3) << jump;
  }
  const Eigen::VectorXd gain = evidence.score.array().square() / evidence.information.array().max(1e-300);
  Eigen::Index best = 0;
  gain.segment(10, 40).maxCoeff(&best);
  EXPECT_NEAR(static_cast<double>(best + 10), 31.0, 1.0) << "where it was";
}

TEST(MotionSmootherTest, FindsTheNoiseOfTheEncoderByItself) {
  for (const double deviation : {1e-6, 1e-4, 1e-2}) {
    const std::vector<double> time = irregularTimes(4000, 0.001, 4);
    const Reach reach{13.0, 1.5};
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0.0, deviation);
    Eigen::VectorXd position(4000);
    for (int k = 0; k < 4000; ++k) position[k] = reach.position(time[static_cast<std::size_t>(k)]) + noise(random);
    EXPECT_NEAR(smoothMotion(time, position).measurement_deviation / deviation, 1.0, 0.05);
  }
  const double step = 2.0 * kPi / 262144.0;  // 2^-18 of a turn
  std::vector<double> time;
  Eigen::VectorXd position(6000);
  for (int k = 0; k < 6000; ++k) {
    time.push_back(0.001 * k);
    position[k] = step * std::round(std::sin(1.7 * time.back()) / step);
  }
  EXPECT_NEAR(smoothMotion(time, position).measurement_deviation / (step / std::sqrt(12.0)), 1.0, 0.1)
      << "quantisation errs evenly within half a step";
}

TEST(MotionSmootherTest, ItsDeviationsAreHonest) {
  const std::vector<double> time = irregularTimes(3000, 0.002, 6);
  const Reach reach{13.0, 2.0};
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 1e-4);
  Eigen::VectorXd position(3000);
  for (int k = 0; k < 3000; ++k) position[k] = reach.position(time[static_cast<std::size_t>(k)]) + noise(random);
  const SmoothedMotion motion = smoothMotion(time, position);
  int within = 0;
  for (int k = 0; k < 3000; ++k) {
    const double deviation = std::sqrt(motion.covariance[static_cast<std::size_t>(k)](2, 2));
    const double error = motion.acceleration[k] - reach.acceleration(time[static_cast<std::size_t>(k)]);
    within += std::abs(error) < 2.0 * deviation ? 1 : 0;
  }
  EXPECT_GT(within, 2790) << "93 % of 3000 within two standard deviations";
}

TEST(MotionSmootherTest, BridgesWhatWasNotMeasuredAndSaysHowUnsurely) {
  const std::vector<double> time = irregularTimes(1000, 0.002, 8);
  const Reach reach{12.2, 1.6};
  std::mt19937 random(9);
  std::normal_distribution<double> noise(0.0, 1e-5);
  Eigen::VectorXd position(1000);
  for (int k = 0; k < 1000; ++k) {
    const bool missing = (k > 400 && k < 430) || k % 7 == 0;
    position[k] = missing ? std::numeric_limits<double>::quiet_NaN()
                          : reach.position(time[static_cast<std::size_t>(k)]) + noise(random);
  }
  const SmoothedMotion motion = smoothMotion(time, position);
  const auto deviation = [&](int k) { return std::sqrt(motion.covariance[static_cast<std::size_t>(k)](0, 0)); };
  EXPECT_GT(deviation(415), 2.0 * deviation(600)) << "in the middle of the hole";
  for (int k = 0; k < 1000; ++k) {
    EXPECT_NEAR(motion.position[k], reach.position(time[static_cast<std::size_t>(k)]), 6.0 * deviation(k)) << k;
  }
}

TEST(MotionSmootherTest, AnArmAtRestIsAtRest) {
  std::vector<double> time;
  for (int k = 0; k < 100; ++k) time.push_back(0.01 * k);
  const SmoothedMotion motion = smoothMotion(time, Eigen::VectorXd::Constant(100, 0.7));
  EXPECT_TRUE(motion.position.isConstant(0.7, 1e-12));
  EXPECT_LT(motion.acceleration.cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_TRUE(motion.covariance[50].allFinite());
}

TEST(MotionSmootherTest, RefusesWhatItCannotSmoothInASentence) {
  const std::vector<double> ten = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  EXPECT_EQ(messageOf(ten, Eigen::VectorXd::Zero(9)),
            "smoothing: there are 10 times for 9 positions, expected as many.");
  EXPECT_EQ(messageOf({0, 1, 1, 2, 3, 4, 5, 6, 7, 8}, Eigen::VectorXd::Zero(10)),
            "smoothing: time 1.000000 s of sample 2 is not finite or does not follow the one before, expected "
            "increasing times.");
  Eigen::VectorXd position = Eigen::VectorXd::Zero(10);
  position[3] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(messageOf(ten, position),
            "smoothing: position 3 is infinite, expected a number, or NaN where it is missing.");
  position.tail(7).setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(messageOf(ten, position),
            "smoothing: 3 positions were measured, expected at least 8 to tell an acceleration from noise.");
  EXPECT_THROW(smoothMotion(ten, Eigen::VectorXd::Zero(10), 0.0), ConfigurationError);
  const auto messageOfJumps = [&](const Eigen::VectorXd& variance) -> std::string {
    const Eigen::VectorXd ramp = Eigen::VectorXd::LinSpaced(10, 0.0, 1.0);
    try {
      smoothMotionAgain(ten, ramp, smoothMotion(ten, ramp), variance);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(messageOfJumps(Eigen::VectorXd::Zero(9)),
            "smoothing: there are 9 variances of jumps for 10 positions, expected as many.");
  EXPECT_EQ(messageOfJumps(Eigen::VectorXd::Constant(10, -1.0)),
            "smoothing: the variance of the jump before sample 0 is -1, expected a number of at least 0.");
}

}  // namespace
}  // namespace demo_logger
