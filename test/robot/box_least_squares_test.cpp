#include "src/robot/box_least_squares.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <random>

namespace demo_logger {
namespace {

struct Problem {
  SquareMatrix H;
  JointVector g, lower, upper;
};

Problem randomProblem(int n, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> width(0.0, 1.0);
  Eigen::MatrixXd A(6, n);
  for (double& value : A.reshaped()) value = normal(generator);
  Problem problem;
  problem.H = A.transpose() * A + 1e-4 * Eigen::MatrixXd::Identity(n, n);
  problem.g.resize(n);
  problem.lower.resize(n);
  problem.upper.resize(n);
  for (int i = 0; i < n; ++i) {
    problem.g[i] = normal(generator);
    problem.lower[i] = -width(generator);
    problem.upper[i] = i % 3 == 2 ? problem.lower[i] : width(generator);  // some joints cannot move at all
  }
  return problem;
}

TEST(BoxLeastSquaresTest, WithoutActiveBoundsItIsTheLinearSolution) {
  SquareMatrix H(2, 2);
  H << 2.0, 0.0, 1.0, 3.0;  // the lower triangle counts
  const JointVector g = Eigen::Vector2d(3.0, 4.0), bound = Eigen::Vector2d(10.0, 10.0);
  JointVector x;
  minimiseInBox(H, g, -bound, bound, x);
  EXPECT_NEAR(x[0], 1.0, 1e-15);  // 2 + 1 = 3, 1 + 3 = 4
  EXPECT_NEAR(x[1], 1.0, 1e-15);
}

TEST(BoxLeastSquaresTest, ABoundMovesTheOthersToo) {
  SquareMatrix H(2, 2);
  H << 2.0, 1.0, 1.0, 3.0;
  const JointVector g = Eigen::Vector2d(3.0, 4.0), lower = Eigen::Vector2d(-1.0, -1.0),
                    upper = Eigen::Vector2d(0.25, 9.0);
  JointVector x;
  minimiseInBox(H, g, lower, upper, x);
  EXPECT_EQ(x[0], 0.25);
  EXPECT_NEAR(x[1], (4.0 - 0.25) / 3.0, 1e-15);
}

/// Karush-Kuhn-Tucker: the slope vanishes where x is free and points out of the box where it is at a bound. For a
/// positive definite H that is the one minimum.
RC_GTEST_PROP(BoxLeastSquaresProperty, TheConditionsOfTheMinimumHold, ()) {
  const int n = *rc::gen::inRange(1, 13);
  const Problem problem = randomProblem(n, *rc::gen::arbitrary<std::uint64_t>());
  JointVector x;
  minimiseInBox(problem.H, problem.g, problem.lower, problem.upper, x);
  const JointVector slope = problem.H * x - problem.g;
  for (int i = 0; i < n; ++i) {
    constexpr double kRounding = 1e-8;  // condition number 1e5
    RC_ASSERT(x[i] >= problem.lower[i]);
    RC_ASSERT(x[i] <= problem.upper[i]);
    if (problem.lower[i] == problem.upper[i]) continue;
    if (x[i] > problem.lower[i]) RC_ASSERT(slope[i] < kRounding);
    if (x[i] < problem.upper[i]) RC_ASSERT(slope[i] > -kRounding);
  }
}

}  // namespace
}  // namespace demo_logger
