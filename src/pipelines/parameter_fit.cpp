#include "parameter_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "possible_bodies.h"

namespace demo_logger {
namespace {

using Index = Eigen::Index;

constexpr int kRounds = 4;  // for weights, friction velocities and the payload's own inertia to settle
constexpr std::array<double, 5> kFrictionVelocities = {0.01, 0.02, 0.05, 0.1, 0.2};  // [rad/s or m/s]
constexpr double kStepGain =
    0.8;  // of what the best of them leaves, that a step must come below; near it few rows tell

}  // namespace

ParameterFit::ParameterFit(FitProblem& problem, std::vector<bool> rows, const Eigen::VectorXd& largest)
    : problem_(problem), rows_(std::move(rows)), variance_(largest.cwiseAbs2()) {}

void ParameterFit::run() {
  for (int round = 0; round < kRounds; ++round) {
    estimate_ = solveRegression(problem_.regression(), sums(), variance_.cwiseInverse(), problem_.prior());
    chooseFrictionVelocities();
    problem_.assumePayload(estimate_.value);
    judgeResiduals();
  }
  const std::vector<JointSums> last = sums();
  const Eigen::VectorXd weight = variance_.cwiseInverse();
  estimate_ = solveRegression(problem_.regression(), last, weight, problem_.prior());
  estimate_.covariance = solveRegression(problem_.regression(), last, weight, problem_.priorOfDeviations()).covariance;
}

void ParameterFit::makeBodiesPossible() {
  const Index count = problem_.regression().inertial.cols();
  constexpr Index kValues = LinearInertia::RowsAtCompileTime;
  std::vector<Index> free;  // of the parameters, body after body
  for (Index at = 0; at < count; at += kValues) {
    if (problem_.prior().deviation.segment<kValues>(at).isZero(0.0)) continue;
    for (Index i = 0; i < kValues; ++i) free.push_back(at + i);
  }
  if (!free.empty()) {
    const Eigen::VectorXd described = problem_.describedBodies()(free);
    const Eigen::VectorXd estimated = estimate_.value(free);
    const Eigen::VectorXd possible =
        nearestPossibleBodies(described + estimated, estimate_.covariance(free, free), described) - described;
    for (std::size_t i = 0; i < free.size(); ++i) problem_.leave(free[i], possible[static_cast<Index>(i)]);
  }
  run();
}

std::vector<JointSums> ParameterFit::sums() const {
  std::vector<JointSums> sums(static_cast<std::size_t>(joints()), JointSums(problem_.regression().inertial.cols()));
  for (Index i = 0; i < joints(); ++i) {
    forEachRow(i, [&](Index k) { sums[static_cast<std::size_t>(i)].add(problem_.regression(), k, i); });
  }
  return sums;
}

void ParameterFit::judgeResiduals() {
  constexpr double kBlock = 0.5;             // [s]
  constexpr double kOwnParameters = 3.5;     // bias, damping, friction, and a share of the payload
  constexpr double kLargestInflation = 4.0;  // for what few blocks do not show
  const Eigen::VectorXd least = problem_.resolution().cwiseAbs2();
  const TorqueEquations& equations = problem_.equations();
  for (Index i = 0; i < joints(); ++i) {
    double squares = 0.0, count = 0.0, block_squares = 0.0, blocks = 0.0, sum = 0.0, in_block = 0.0;
    std::pair<std::size_t, long> block{};
    const auto close = [&] {
      if (in_block > 0.0) block_squares += sum * sum;
      blocks += in_block > 0.0 ? 1.0 : 0.0;
      sum = in_block = 0.0;
    };
    forEachRow(i, [&](Index k) {
      const auto row = static_cast<std::size_t>(k);
      const std::pair<std::size_t, long> own{equations.range[row], std::lround(equations.time[row] / kBlock)};
      if (own != block) close();
      block = own;
      const double residual = problem_.regression().residual(k, i, estimate_.value);
      squares += residual * residual;
      sum += residual;
      count += 1.0;
      in_block += 1.0;
    });
    close();
    if (count == 0.0) continue;
    const double free = std::max(blocks - kOwnParameters, blocks / kLargestInflation);
    variance_[i] = std::max({squares / count, block_squares / count, least[i]}) * blocks / free;
  }
}

void ParameterFit::chooseFrictionVelocities() {
  for (Index i = 0; i < joints(); ++i) {
    if (!problem_.mayChooseFrictionVelocity(i)) continue;
    double least = std::numeric_limits<double>::infinity();
    double best = problem_.frictionVelocity(i);
    for (const double velocity : kFrictionVelocities) {
      const double left = leftWith(i, velocity);
      if (left >= least) continue;
      least = left;
      best = velocity;
    }
    if (leftWith(i, 0.0) < kStepGain * least) best = 0.0;
    problem_.assumeFrictionVelocity(i, best);
  }
}

double ParameterFit::leftWith(Index i, double velocity) const {
  const TorqueRegression& regression = problem_.regression();
  Eigen::Matrix4d sums = Eigen::Matrix4d::Zero();  // of (1, q̇, sign, y)
  Eigen::VectorXd theta = estimate_.value;
  theta.segment<TorqueRegression::kOfJoint>(regression.indexOf(i, 0)).setZero();
  for (Index k = 0; k < regression.rows(); ++k) {
    if (!rows_[static_cast<std::size_t>(k)] || !problem_.moves(k, i) || std::isnan(regression.unexplained(k, i))) {
      continue;
    }
    const Eigen::Vector4d x(1.0, regression.velocity(k, i), problem_.signAt(k, i, velocity).mean,
                            regression.residual(k, i, theta));
    sums += x * x.transpose();
  }
  Eigen::Matrix3d A = sums.topLeftCorner<3, 3>();
  A.diagonal() += Eigen::Vector3d::Constant(1e-9 * (A.trace() + 1.0));
  const Eigen::Vector3d b = sums.topRightCorner<3, 1>();
  return sums(3, 3) - b.dot(A.ldlt().solve(b));
}

}  // namespace demo_logger
