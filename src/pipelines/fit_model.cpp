#include "demo_logger/pipelines/fit_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "arm_motion.h"
#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/not_a_number.h"
#include "demo_logger/trajectory/print.h"
#include "fit_findings.h"
#include "fit_problem.h"
#include "hand_free_search.h"
#include "joint_columns.h"
#include "possible_bodies.h"

namespace demo_logger {
namespace {

using Index = Eigen::Index;

constexpr double kNoiseTimes = 5.0;     // a residual that sensors alone may leave
constexpr double kDoubtfulTimes = 2.0;  // a residual's tolerance, above which a part without a hand is doubted
constexpr int kRounds = 4;              // for weights, friction velocities and the payload's own inertia to settle
constexpr std::array<double, 5> kFrictionVelocities = {0.01, 0.02, 0.05, 0.1, 0.2};  // [rad/s or m/s]
constexpr double kStepGain =
    0.8;  // of what the best of them leaves, that a step must come below; near it few rows tell

EffortMetadata commonMeaning(const std::vector<const Demonstration*>& recordings, const FitOptions& options) {
  if (recordings.empty()) throw ConfigurationError("there is no recording to fit a model to");
  EffortMetadata meaning = options.effort.value_or(recordings.front()->metadata.effort);
  for (const Demonstration* recording : recordings) {
    const EffortMetadata& other = recording->metadata.effort;
    if (options.effort || (other.side == meaning.side && other.includes_gravity == meaning.includes_gravity)) continue;
    throw ConfigurationError(
        "the recordings' efforts were measured at different sides of the gears, or one with and one without gravity, "
        "expected the same of all; fit each kind by itself");
  }
  return meaning;
}

TorqueEquations equationsOf(const RobotDescription& robot, const std::vector<const Demonstration*>& recordings,
                            const FitOptions& options) {
  TorqueEquations equations;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    const EffortMetadata meaning = options.effort.value_or(recordings[r]->metadata.effort);
    validate(meaning);
    const RecordedJoints joints = readJoints(robot, *recordings[r]);
    if (!joints.without_effort.empty()) {
      throw ConfigurationError(whyNoEfforts(joints, joints.without_effort.front()) +
                               ", which a model would have to explain");
    }
    std::vector<std::string> notes;  // addHumanTorque says them
    for (const RowRange& range : rangesWithoutSilence(recordings[r]->time, joints.position, options.max_gap, notes)) {
      appendEquations(robot, smoothArm(recordings[r]->time, joints, range, meaning, MeasuredEfforts::raw), r,
                      equations);
    }
  }
  return equations;
}

std::vector<bool> rowsWithin(const std::vector<TimeSpan>& spans, const TorqueEquations& equations) {
  std::vector<bool> rows;
  for (const double time : equations.time) {
    rows.push_back(std::any_of(spans.begin(), spans.end(),
                               [&](const TimeSpan& span) { return time >= span.from && time <= span.to; }));
  }
  return rows;
}

/// The regression on chosen rows, with weights that its own residuals give.
class Fit {
 public:
  Fit(FitProblem& problem, std::vector<bool> rows, const Eigen::VectorXd& largest)
      : problem_(problem), rows_(std::move(rows)), variance_(largest.cwiseAbs2()) {}

  void run() {
    for (int round = 0; round < kRounds; ++round) {
      estimate_ = solveRegression(problem_.regression(), sums(), variance_.cwiseInverse(), problem_.prior());
      chooseFrictionVelocities();
      problem_.assumePayload(estimate_.value);
      judgeResiduals();
    }
    estimate_ = solveRegression(problem_.regression(), sums(), variance_.cwiseInverse(), problem_.prior());
  }

  /// The nearest bodies that there can be, and what goes with them of the drives.
  void makeBodiesPossible() {
    const Index count = problem_.regression().inertial.cols();
    const Eigen::VectorXd described = problem_.describedBodies();
    const Eigen::VectorXd before = estimate_.value.head(count);
    const auto& C = estimate_.covariance;
    const Eigen::VectorXd possible =
        nearestPossibleBodies(described + before, C.topLeftCorner(count, count), described) - described;
    const Index drives = estimate_.value.size() - count;
    estimate_.value.tail(drives) +=
        C.bottomLeftCorner(drives, count) * C.topLeftCorner(count, count).ldlt().solve(possible - before);
    estimate_.value.head(count) = possible;
    for (Index i = count; i < estimate_.value.size(); ++i) {
      if (problem_.prior().not_negative[static_cast<std::size_t>(i)]) {
        estimate_.value[i] = std::max(0.0, estimate_.value[i]);
      }
    }
  }

  const RidgeEstimate& estimate() const { return estimate_; }

  /// Per joint, root mean square over the chosen rows.
  std::vector<double> residual(const Eigen::VectorXd& theta) const {
    std::vector<double> result;
    for (Index i = 0; i < joints(); ++i) {
      double squares = 0.0;
      double count = 0.0;
      forEachRow(i, [&](Index k) {
        squares += std::pow(problem_.regression().residual(k, i, theta), 2);
        count += 1.0;
      });
      result.push_back(count > 0.0 ? std::sqrt(squares / count) : kNaN);
    }
    return result;
  }

 private:
  Index joints() const { return problem_.regression().joints; }

  template <typename Visit>
  void forEachRow(Index joint, const Visit& visit) const {
    for (Index k = 0; k < problem_.regression().rows(); ++k) {
      if (rows_[static_cast<std::size_t>(k)] && problem_.regression().says(k, joint)) visit(k);
    }
  }

  std::vector<JointSums> sums() const {
    std::vector<JointSums> sums(static_cast<std::size_t>(joints()), JointSums(problem_.regression().inertial.cols()));
    for (Index i = 0; i < joints(); ++i) {
      forEachRow(i, [&](Index k) { sums[static_cast<std::size_t>(i)].add(problem_.regression(), k, i); });
    }
    return sums;
  }

  /// How much the residuals of a joint say, row by row, though neighbours err alike: the variance that independent ones
  /// would have whose means over blocks vary as much.
  void judgeResiduals() {
    constexpr double kBlock = 0.5;             // [s]
    constexpr double kOwnParameters = 3.5;     // bias, damping, friction, and a share of the payload
    constexpr double kLargestInflation = 4.0;  // for what few blocks do not show
    constexpr double kRounding = 1e-9;         // [N m or N]
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
      variance_[i] = std::max({squares / count, block_squares / count, kRounding * kRounding}) * blocks / free;
    }
  }

  /// For each joint the v that leaves the least, its own bias, damping and friction fitted anew.
  void chooseFrictionVelocities() {
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

  double leftWith(Index i, double velocity) const {
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

  FitProblem& problem_;
  const std::vector<bool> rows_;
  Eigen::VectorXd variance_;
  RidgeEstimate estimate_;
};

void describeRows(const FitProblem& problem, const std::vector<bool>& rows, FitResult& result) {
  const TorqueEquations& equations = problem.equations();
  std::size_t last = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (!rows[k] || !problem.regression().says.row(static_cast<Index>(k)).any()) continue;
    const bool continues = result.rows > 0 && last + 1 == k && equations.range[last] == equations.range[k];
    if (!continues) result.hand_free.push_back({equations.recording[k], {equations.time[k], equations.time[k]}});
    result.hand_free.back().span.to = equations.time[k];
    ++result.rows;
    last = k;
  }
  for (const FitResult::Part& part : result.hand_free) result.duration += part.span.to - part.span.from;
}

std::string whyUndetermined(const FitResult& result, const FitOptions& options) {
  if (result.duration >= options.least_duration) return {};
  const std::string found = print(result.duration, 1) + " s";
  const std::string expected = "expected at least " + print(options.least_duration) + " s";
  if (!options.hand_free.empty()) {
    return "the parts without a hand that were given hold " + found +
           " in which an effort tells something (a joint that friction holds still does not), " + expected;
  }
  return "only " + found + " can be taken as free of a hand's touch, " + expected +
         " that one payload, torque bias and friction explain to within " + print(100.0 * options.model_error) +
         " % of what the joints usually bear; say where no hand is (--hand-free FROM:TO), or allow the model to be "
         "worse (--model-error)";
}

/// Parts that were found agree with one model; those that were given may not.
std::vector<std::string> doubtsOf(const RobotDescription& robot, const std::vector<double>& residual,
                                  const Eigen::VectorXd& tolerance) {
  std::vector<std::string> doubts;
  for (std::size_t i = 0; i < residual.size(); ++i) {
    const double tolerated = tolerance[static_cast<Index>(i)];
    if (!(residual[i] > kDoubtfulTimes * tolerated)) continue;
    const std::string unit = robot.joints[i].type == JointType::prismatic ? " N" : " N m";
    doubts.push_back(robot.joints[i].name + ": what is left in the given parts is " + print(residual[i], 3) + unit +
                     " (root mean square), where the model may be off by " + print(tolerated, 3) + unit +
                     "; is the hand really away there?");
  }
  return doubts;
}

}  // namespace

FitResult fitModel(const RobotDescription& robot, const std::vector<const Demonstration*>& recordings,
                   const FitOptions& options) {
  const EffortMetadata meaning = commonMeaning(recordings, options);
  FitProblem problem(robot, options, meaning, equationsOf(robot, recordings, options));
  HandFreeTolerance tolerance{options.model_error * problem.usualTorque(), problem.noise()};
  tolerance.largest = tolerance.largest.cwiseMax(kNoiseTimes * tolerance.noise);
  std::vector<bool> rows;
  if (options.hand_free.empty()) {
    rows = findHandFreeRows(problem.equations(), problem.regression(), tolerance, problem.prior());
    Fit(problem, rows, tolerance.largest).run();
    rows = keepUsualRows(problem.equations(), problem.regression(), tolerance, problem.prior(), rows);
  } else {
    rows = rowsWithin(options.hand_free, problem.equations());
  }
  FitResult result;
  describeRows(problem, rows, result);
  result.undetermined = whyUndetermined(result, options);
  if (!result.undetermined.empty()) return result;

  Fit fit(problem, rows, tolerance.largest);
  result.residual_start = fit.residual(problem.prior().mean);
  fit.run();
  if (options.bodies) {
    problem.freeBodies();
    fit.run();
    fit.makeBodiesPossible();
  }
  result.residual = fit.residual(fit.estimate().value);
  if (!options.hand_free.empty()) result.doubts = doubtsOf(robot, result.residual, tolerance.largest);
  describeFit(problem, fit.estimate(), options, meaning, result);
  return result;
}

}  // namespace demo_logger
