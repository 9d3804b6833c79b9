#include "arm_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/motion_smoother.h"
#include "demo_logger/trajectory/not_a_number.h"
#include "demo_logger/trajectory/print.h"
#include "effort_series.h"
#include "friction_jumps.h"
#include "joint_columns.h"

namespace demo_logger {

using Index = Eigen::Index;

namespace {

constexpr double kMostPosition = 1e4;  // [rad or m] beyond where any joint is

/// Without a sidecar the unit follows from the name, which knows of no joints that slide.
void requireUnit(const Column& column, const JointQuantity& quantity, const ArmJoint& joint) {
  const bool slides = joint.type == JointType::prismatic;
  const std::string& unit = column.unit;
  if (unit.empty() || unit == quantity.turning || (slides && unit == quantity.sliding)) return;
  throw ConfigurationError("column `" + column.name + "` is in \"" + unit + "\", expected " +
                           (slides ? quantity.sliding : quantity.turning) + " for the " + quantity.word +
                           " of joint '" + joint.name + "'; convert it, or mend the sidecar");
}

/// Values that no arm has count as missing.
void takeSane(Eigen::MatrixXd::ColXpr values, double most, const ArmJoint& joint, const JointQuantity& quantity,
              std::vector<std::string>& notes) {
  std::size_t rows = 0;
  double first = kNaN;
  for (double& value : values) {
    if (!(std::abs(value) > most)) continue;
    if (rows++ == 0) first = value;
    value = kNaN;
  }
  if (rows == 0) return;
  notes.push_back("joint '" + joint.name + "' has the " + quantity.word + " " + print(first) +
                  (rows == 1 ? "" : ", the first of " + std::to_string(rows) + " such values") +
                  ", which no arm has: it counts as missing");
}

}  // namespace

RecordedJoints readJoints(const RobotDescription& robot, const Demonstration& demonstration) {
  const std::vector<std::string> names = robot.jointNames();
  const Index rows = demonstration.values.rows();
  const auto count = static_cast<Index>(names.size());
  RecordedJoints joints;
  joints.position = joints.effort = Eigen::MatrixXd::Constant(rows, count, kNaN);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto position = findJointColumn(demonstration.columns, kPosition, names[i]);
    if (!position) {
      throw ConfigurationError("no column `" + jointColumnName(kPosition, names[i]) + "` with the position of joint '" +
                               names[i] + "', which the torques depend on");
    }
    const auto column = static_cast<Index>(i);
    const auto take = [&](std::size_t from, const JointQuantity& quantity, double most, Eigen::MatrixXd& into) {
      requireUnit(demonstration.columns[from], quantity, robot.joints[i]);
      into.col(column) = demonstration.values.col(static_cast<Index>(from));
      takeSane(into.col(column), most, robot.joints[i], quantity, joints.notes);
    };
    take(*position, kPosition, kMostPosition, joints.position);
    const auto effort = findJointColumn(demonstration.columns, kEffort, names[i]);
    if (effort) take(*effort, kEffort, kMostTorque, joints.effort);
    if (joints.effort.col(column).array().isNaN().all()) joints.without_effort.push_back(names[i]);
    joints.has_effort_columns = joints.has_effort_columns || effort.has_value();
  }
  if (joints.without_effort.size() == names.size()) joints.effort.resize(0, 0);
  return joints;
}

std::string whyNoEfforts(const RecordedJoints& joints, const std::string& joint) {
  const std::string column = "column `" + jointColumnName(kEffort, joint) + "`";
  return (joints.has_effort_columns ? column + " holds no efforts" : "no " + column + " with efforts") + " of joint '" +
         joint + "'";
}

std::vector<RowRange> rangesWithoutSilence(const std::vector<double>& time, const Eigen::MatrixXd& position,
                                           double max_gap, std::vector<std::string>& notes) {
  std::vector<RowRange> ranges;
  std::vector<std::size_t> measured;  // rows in the last of them
  std::size_t too_short = 0;
  const auto close = [&] {
    if (measured.size() >= static_cast<std::size_t>(kFewestSamples)) {
      ranges.push_back({measured.front(), measured.back() + 1});
    } else if (!measured.empty()) {
      ++too_short;
    }
    measured.clear();
  };
  for (std::size_t k = 0; k < time.size(); ++k) {
    if (!position.row(static_cast<Index>(k)).allFinite()) continue;
    if (!measured.empty() && time[k] - time[measured.back()] > max_gap) close();
    measured.push_back(k);
  }
  close();
  if (ranges.size() > 1) {
    const std::size_t silences = ranges.size() - 1 + too_short;
    notes.push_back("the joints were silent for more than " + print(max_gap) + " s, " +
                    (silences == 1 ? "once" : std::to_string(silences) + " times") + "; nothing is said across that");
  }
  if (too_short > 0) {
    notes.push_back(std::to_string(too_short) +
                    (too_short == 1 ? " part between silences has" : " parts between silences have") + " fewer than " +
                    std::to_string(kFewestSamples) +
                    " rows, too few to tell an acceleration: " + (too_short == 1 ? "it stays NaN" : "they stay NaN"));
  }
  return ranges;
}

namespace {

/// `position`: rows x joints, at the times.
std::vector<SmoothedMotion> smoothJoints(const std::vector<double>& time, const Eigen::MatrixXd& position) {
  std::vector<SmoothedMotion> motions;
  for (Index i = 0; i < position.cols(); ++i) motions.push_back(smoothMotion(time, position.col(i)));
  return motions;
}

/// As the friction of the joints makes them move.
std::vector<SmoothedMotion> smoothJoints(const std::vector<double>& time, const Eigen::MatrixXd& position,
                                         const RobotModel& model) {
  std::vector<JointInMotion> joints(static_cast<std::size_t>(position.cols()));
  for (std::size_t i = 0; i < joints.size(); ++i) {
    joints[i].motion = smoothMotion(time, position.col(static_cast<Index>(i)), joints[i].jumps);
  }
  const Eigen::MatrixXd jumps = frictionJumps(model, time, joints);
  std::vector<SmoothedMotion> motions;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const auto column = static_cast<Index>(i);
    const bool jumps_never = jumps.col(column).isZero(0.0);
    motions.push_back(jumps_never ? std::move(joints[i].motion)
                                  : smoothMotionAgain(time, position.col(column), joints[i].motion, jumps.col(column)));
  }
  return motions;
}

}  // namespace

ArmMotion smoothArm(const std::vector<double>& time, const RecordedJoints& joints, const RowRange& range,
                    const EffortMetadata& meaning, MeasuredEfforts efforts, const RobotModel* model) {
  ArmMotion motion;
  motion.first_row = range.first;
  motion.time.assign(time.begin() + static_cast<std::ptrdiff_t>(range.first),
                     time.begin() + static_cast<std::ptrdiff_t>(range.last));
  const auto first = static_cast<Index>(range.first);
  const auto rows = static_cast<Index>(motion.time.size());
  const Index n = joints.position.cols();
  motion.position = motion.velocity = motion.acceleration = Eigen::MatrixXd(rows, n);
  motion.velocity_variance = motion.acceleration_variance = Eigen::MatrixXd(rows, n);
  if (joints.effort.size() > 0) motion.effort = motion.effort_variance = Eigen::MatrixXd(rows, n);
  motion.noise.resize(n);
  const Eigen::MatrixXd positions = joints.position.middleRows(first, rows);
  const std::vector<SmoothedMotion> motions = model && hasFriction(model->description())
                                                  ? smoothJoints(motion.time, positions, *model)
                                                  : smoothJoints(motion.time, positions);
  for (Index i = 0; i < n; ++i) {
    const SmoothedMotion& joint = motions[static_cast<std::size_t>(i)];
    motion.position.col(i) = joint.position;
    motion.velocity.col(i) = joint.velocity;
    motion.acceleration.col(i) = joint.acceleration;
    for (Index k = 0; k < rows; ++k) {
      const Eigen::Matrix3d& covariance = joint.covariance[static_cast<std::size_t>(k)];
      motion.velocity_variance(k, i) = std::max(0.0, covariance(1, 1));
      motion.acceleration_variance(k, i) = std::max(0.0, covariance(2, 2));
    }
    motion.noise[i] = joint.measurement_deviation;
    if (joints.effort.size() == 0) continue;
    if (efforts == MeasuredEfforts::raw && meaning.timing == "instant") {
      motion.effort.col(i) = joints.effort.col(i).segment(first, rows);
      motion.effort_variance.col(i).setZero();
      continue;
    }
    const EffortSeries effort = torqueAtStamps(motion.time, joints.effort.col(i).segment(first, rows), meaning);
    motion.effort.col(i) = effort.torque;
    motion.effort_variance.col(i) = effort.variance;
  }
  return motion;
}

VelocitySign signOf(double velocity, double deviation, double friction_velocity) {
  if (friction_velocity > 0.0) {
    const double mean = std::tanh(velocity / friction_velocity);
    return {mean, std::pow((1.0 - mean * mean) * deviation / friction_velocity, 2)};
  }
  const double mean = std::erf(velocity / (std::sqrt(2.0) * std::max(deviation, 1e-12)));
  return {mean, 1.0 - mean * mean};
}

}  // namespace demo_logger
