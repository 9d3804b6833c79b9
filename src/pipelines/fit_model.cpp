#include "demo_logger/pipelines/fit_model.h"

#include <algorithm>
#include <cmath>

#include "arm_motion.h"
#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/print.h"
#include "fit_decisions.h"
#include "fit_findings.h"
#include "fit_problem.h"
#include "hand_free_search.h"
#include "joint_columns.h"
#include "parameter_fit.h"

namespace demo_logger {
namespace {

using Index = Eigen::Index;

constexpr double kNoiseTimes = 5.0;     // a residual that sensors alone may leave
constexpr double kDoubtfulTimes = 2.0;  // a residual's tolerance, above which a part without a hand is doubted

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
         ", a second of it in one piece, that one payload, torque bias and friction explain to within " +
         print(100.0 * options.model_error) +
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
    doubts.push_back(std::string(robot.joints[i].name)
                         .append(": what is left in the given parts is ")
                         .append(print(residual[i], 3) + unit)
                         .append(" (root mean square), where the model may be off by ")
                         .append(print(tolerated, 3) + unit)
                         .append("; is the hand really away there?"));
  }
  return doubts;
}

void refuseWhatIsNotFinite(const FitProblem& problem, const Eigen::VectorXd& theta) {
  if (theta.allFinite()) return;
  const TorqueEquations& equations = problem.equations();
  Index row = 0;
  Index joint = 0;
  equations.effort.array().isNaN().select(0.0, equations.effort.cwiseAbs()).maxCoeff(&row, &joint);
  throw ConfigurationError(
      "no finite model explains the efforts, the largest of which is " + print(equations.effort(row, joint)) +
      " N m or N of joint '" + problem.robot().joints[static_cast<std::size_t>(joint)].name + "' at " +
      print(equations.time[static_cast<std::size_t>(row)], 3) + " s of recording " +
      std::to_string(equations.recording[static_cast<std::size_t>(row)] + 1) + "; are its units right?");
}

struct Settled {
  RidgeEstimate estimate;
  FitDecisions decisions;
};

/// Until nothing of the estimate has to be taken otherwise than it is.
Settled settle(FitProblem& problem, ParameterFit& fit) {
  Settled settled;
  do {
    fit.run();
  } while (decide(problem, fit.estimate(), settled.decisions));
  if (problem.hasFreeBodies()) fit.makeBodiesPossible();
  settled.estimate = fit.estimate();
  refuseWhatIsNotFinite(problem, settled.estimate.value);
  return settled;
}

}  // namespace

FitResult fitModel(const RobotDescription& robot, const std::vector<const Demonstration*>& recordings,
                   const FitOptions& options) {
  const EffortMetadata meaning = commonMeaning(recordings, options);
  FitProblem problem(robot, options, meaning, equationsOf(robot, recordings, options));
  HandFreeTolerance tolerance{options.model_error * problem.usualTorque(), problem.noise()};
  tolerance.largest = tolerance.largest.cwiseMax(kNoiseTimes * tolerance.noise).cwiseMax(problem.resolution());
  std::vector<bool> rows;
  if (options.hand_free.empty()) {
    rows = findHandFreeRows(problem.equations(), problem.regression(), tolerance, problem.prior());
    FitProblem known = problem;
    ParameterFit fit(known, rows, tolerance.largest);
    settle(known, fit);
    rows = keepUsualRows(known.equations(), known.regression(), tolerance, problem.prior(), rows);
  } else {
    rows = rowsWithin(options.hand_free, problem.equations());
  }
  FitResult result;
  describeRows(problem, rows, result);
  result.undetermined = whyUndetermined(result, options);
  if (!result.undetermined.empty()) return result;

  result.residual_start = problem.residual(calibrate(robot, options.start), rows);
  ParameterFit fit(problem, rows, tolerance.largest);
  if (options.bodies) {
    fit.run();  // for the velocities of friction, and what residuals are like
    problem.freeBodies();
  }
  const Settled settled = settle(problem, fit);
  describeFit(problem, settled.estimate, settled.decisions, options, meaning, result);
  result.residual = problem.residual(calibrate(robot, result.calibration), rows);
  if (!options.hand_free.empty()) result.doubts = doubtsOf(robot, result.residual, tolerance.largest);
  return result;
}

}  // namespace demo_logger
