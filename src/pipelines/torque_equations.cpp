#include "torque_equations.h"

#include <algorithm>
#include <cmath>

#include "demo_logger/robot/robot_model.h"

namespace demo_logger {

namespace {

using Index = Eigen::Index;

/// Variance of what is not alike in three neighbours, the median of many so that steps do not count.
double noiseVariance(const Eigen::VectorXd& series) {
  constexpr double kMedianOfChiSquare = 0.455;
  std::vector<double> squares;
  for (Index k = 1; k + 1 < series.size(); ++k) {
    const double curvature = series[k - 1] - 2.0 * series[k] + series[k + 1];
    if (!std::isnan(curvature)) squares.push_back(curvature * curvature / 6.0);
  }
  if (squares.empty()) return 0.0;
  const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
  std::nth_element(squares.begin(), middle, squares.end());
  return *middle / kMedianOfChiSquare;
}

}  // namespace

void appendEquations(const RobotDescription& robot, const ArmMotion& motion, std::size_t index,
                     TorqueEquations& equations) {
  std::vector<Index> chosen;
  for (std::size_t k = 0; k < motion.time.size(); ++k) {
    const bool is_due = chosen.empty() || motion.time[k] - motion.time[static_cast<std::size_t>(chosen.back())] >=
                                              kEquationInterval * (1.0 - 1e-6);
    if (is_due) chosen.push_back(static_cast<Index>(k));
  }
  const std::size_t range = equations.range.empty() ? 0 : equations.range.back() + 1;
  const Index before = equations.rows();
  const auto added = static_cast<Index>(chosen.size());
  const Index n = motion.position.cols();
  for (Eigen::MatrixXd* matrix : {&equations.position, &equations.velocity, &equations.acceleration,
                                  &equations.velocity_deviation, &equations.effort, &equations.noise_variance}) {
    matrix->conservativeResize(before + added, n);
  }
  Eigen::RowVectorXd effort_noise(n);
  for (Index i = 0; i < n; ++i) effort_noise[i] = noiseVariance(motion.effort.col(i));
  const RobotModel model(robot);
  Eigen::MatrixXd inertia;
  for (Index i = 0; i < added; ++i) {
    const Index k = chosen[static_cast<std::size_t>(i)];
    const Index row = before + i;
    equations.recording.push_back(index);
    equations.range.push_back(range);
    equations.time.push_back(motion.time[static_cast<std::size_t>(k)]);
    equations.position.row(row) = motion.position.row(k);
    equations.velocity.row(row) = motion.velocity.row(k);
    equations.acceleration.row(row) = motion.acceleration.row(k);
    equations.velocity_deviation.row(row) = motion.velocity_variance.row(k).cwiseSqrt();
    // As many rows before as after, so that their mean is of the same instant.
    const Index before_this = i > 0 ? k - chosen[static_cast<std::size_t>(i) - 1] : 0;
    const Index after_this = i + 1 < added ? chosen[static_cast<std::size_t>(i) + 1] - k : 0;
    const Index half = (std::min(before_this, after_this) - 1) / 2;
    equations.effort.row(row) = motion.effort.middleRows(k - half, 2 * half + 1).colwise().mean();
    model.massMatrix(motion.position.row(k), inertia);
    equations.noise_variance.row(row) =
        effort_noise / static_cast<double>(2 * half + 1) +
        (inertia.cwiseAbs2() * motion.acceleration_variance.row(k).transpose()).transpose();
  }
}

}  // namespace demo_logger
