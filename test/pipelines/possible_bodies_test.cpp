#include "src/pipelines/possible_bodies.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <cmath>
#include <random>

namespace demo_logger {
namespace {

/// A ball of 2 kg and 0.1 m, off the origin: I = 2/5 m r² about its centre.
LinearInertia ball() {
  return linearInertia({2.0, {0.05, -0.02, 0.1}, 0.4 * 2.0 * 0.01 * Eigen::Matrix3d::Identity()});
}

TEST(PossibleBodiesTest, ABallCanBeAndABodyAgainstTheTriangleInequalityCannot) {
  EXPECT_TRUE(isPossible(ball()));
  LinearInertia flat = ball();
  flat[4] *= 3.0;  // I_xx beyond I_yy + I_zz
  EXPECT_FALSE(isPossible(flat));
  LinearInertia weightless = ball();
  weightless[0] = -0.1;
  EXPECT_FALSE(isPossible(weightless));
}

TEST(PossibleBodiesTest, WhatCanBeStaysAsItIs) {
  const Eigen::VectorXd found =
      nearestPossibleBodies(ball(), 1e-4 * Eigen::MatrixXd::Identity(10, 10), /*before=*/ball());
  EXPECT_LT((found - ball()).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(PossibleBodiesTest, TheNearestBodyIsNearerThanAnyOtherThatIsTried) {
  Eigen::VectorXd estimate = ball();
  estimate[4] *= 3.0;
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd roots(10, 10);
  for (double& entry : roots.reshaped()) entry = normal(random);
  const Eigen::MatrixXd C = 1e-4 * (roots * roots.transpose() + Eigen::MatrixXd::Identity(10, 10));
  const Eigen::VectorXd found = nearestPossibleBodies(estimate, C, ball());
  EXPECT_TRUE(isPossible(found));
  const auto distance = [&](const Eigen::VectorXd& body) {
    return (body - estimate).dot(C.ldlt().solve(body - estimate));
  };
  int tried = 0;
  for (int i = 0; i < 200000; ++i) {
    Eigen::VectorXd other = found;
    const double size = 0.003 * std::pow(10.0, -3.0 * (i % 100) / 100.0);
    for (double& entry : other) entry += size * normal(random);
    if (!isPossible(other)) continue;
    ++tried;
    EXPECT_GT(distance(other), distance(found) * (1.0 - 1e-3)) << i;
  }
  EXPECT_GT(tried, 1000);
}

TEST(PossibleBodiesTest, AlsoSeveralBodiesThatAreHardlyKnownApartAreTheNearest) {
  // What can be is a cone, and the distance is convex: the nearest bodies φ are those from which no point mass, of
  // which all bodies are made, leads nearer, and at which more or less of φ itself does not either.
  constexpr Eigen::Index kBodies = 3;
  constexpr Eigen::Index kSize = 10 * kBodies;
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd roots(kSize, kSize);
  for (double& entry : roots.reshaped()) entry = normal(random);
  const Eigen::MatrixXd basis = Eigen::MatrixXd(Eigen::HouseholderQR<Eigen::MatrixXd>(roots).householderQ());
  Eigen::VectorXd variances(kSize);  // over eight decades
  for (Eigen::Index i = 0; i < kSize; ++i) variances[i] = std::pow(10.0, -8.0 * static_cast<double>(i) / (kSize - 1));
  const Eigen::MatrixXd C = basis * variances.asDiagonal() * basis.transpose();
  Eigen::VectorXd before(kSize);
  for (Eigen::Index b = 0; b < kBodies; ++b) before.segment<10>(10 * b) = ball();
  const Eigen::VectorXd estimate =
      before + basis * (variances.cwiseSqrt().asDiagonal() *
                        Eigen::VectorXd::NullaryExpr(kSize, [&](Eigen::Index) { return 3.0 * normal(random); }));
  const Eigen::VectorXd found = nearestPossibleBodies(estimate, C, before);
  const Eigen::VectorXd slope = C.ldlt().solve(found - estimate);
  const double distance = (found - estimate).dot(slope);
  EXPECT_GT(distance, 1.0) << "the estimate cannot be";
  EXPECT_NEAR(slope.dot(found), 0.0, 1e-5 * distance);
  for (Eigen::Index b = 0; b < kBodies; ++b) {
    EXPECT_TRUE(isPossible(found.segment<10>(10 * b)));
    for (int i = 0; i < 10000; ++i) {
      const double far = std::pow(10.0, normal(random));
      const Eigen::Vector3d where = far * Eigen::Vector3d(normal(random), normal(random), normal(random)) / 3.0;
      const LinearInertia point = linearInertia({1.0, where, Eigen::Matrix3d::Zero()}) / (1.0 + where.squaredNorm());
      EXPECT_GT(slope.segment<10>(10 * b).dot(point), -1e-4 * distance) << where.transpose();
    }
  }
}

}  // namespace
}  // namespace demo_logger
