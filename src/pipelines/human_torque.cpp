#include "demo_logger/pipelines/human_torque.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/motion_smoother.h"
#include "demo_logger/trajectory/print.h"
#include "effort_series.h"
#include "joint_columns.h"

namespace demo_logger {
namespace {

using Index = Eigen::Index;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kRecovered = "human torque/";
constexpr double kSingular = 1e-6;  // of the largest singular value, below which a direction says nothing

/// Rows [first, last) without a silence of the joints.
struct Segment {
  std::size_t first;
  std::size_t last;
};

struct Recording {
  Eigen::MatrixXd q;       // rows x joints
  Eigen::MatrixXd effort;  // ditto; empty: none
};

EffortMetadata meaningOf(const Demonstration& demonstration, const HumanTorqueOptions& options) {
  EffortMetadata meaning = options.effort.value_or(demonstration.metadata.effort);
  validate(meaning);
  return meaning;
}

Recording readJoints(const RobotDescription& robot, const Demonstration& demonstration,
                     const HumanTorqueOptions& options, HumanTorqueSummary& summary) {
  const std::vector<std::string> joints = robot.jointNames();
  const Index rows = demonstration.values.rows();
  Recording recording{Eigen::MatrixXd(rows, joints.size()), {}};
  std::string without_effort;
  Eigen::MatrixXd effort(rows, joints.size());
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const auto position = findJointColumn(demonstration.columns, kPosition, joints[i]);
    if (!position) {
      throw ConfigurationError("no column `" + jointColumnName(kPosition, joints[i]) +
                               "` with the position of joint '" + joints[i] + "', which the torques depend on");
    }
    const auto column = static_cast<Index>(i);
    recording.q.col(column) = demonstration.values.col(static_cast<Index>(*position));
    const auto found = findJointColumn(demonstration.columns, kEffort, joints[i]);
    if (found) effort.col(column) = demonstration.values.col(static_cast<Index>(*found));
    if (without_effort.empty() && (!found || effort.col(column).array().isNaN().all())) without_effort = joints[i];
  }
  if (without_effort.empty()) {
    recording.effort = std::move(effort);
    if (options.gravity_compensated) {
      summary.notes.push_back("the arm counts as compensated for gravity, so its recorded efforts are not used");
      recording.effort.resize(0, 0);
    }
    return recording;
  }
  if (!options.gravity_compensated) {
    throw ConfigurationError("no column `" + jointColumnName(kEffort, without_effort) + "` with efforts of joint '" +
                             without_effort +
                             "', without which the human's torque cannot be told from the motor's; if the arm was "
                             "compensated for gravity alone, say so (--gravity-compensated)");
  }
  summary.notes.push_back("no efforts were recorded: the motors count as compensating gravity, and nothing else");
  return recording;
}

/// Where every joint has a position now and again.
std::vector<Segment> segmentsOf(const std::vector<double>& time, const Eigen::MatrixXd& q, double max_gap,
                                HumanTorqueSummary& summary) {
  std::vector<Segment> segments;
  std::vector<std::size_t> measured;  // rows in the last of them
  std::size_t too_short = 0;
  const auto close = [&] {
    if (measured.size() >= static_cast<std::size_t>(kFewestSamples)) {
      segments.push_back({measured.front(), measured.back() + 1});
    } else if (!measured.empty()) {
      ++too_short;
    }
    measured.clear();
  };
  for (std::size_t k = 0; k < time.size(); ++k) {
    if (!q.row(static_cast<Index>(k)).allFinite()) continue;
    if (!measured.empty() && time[k] - time[measured.back()] > max_gap) close();
    measured.push_back(k);
  }
  close();
  if (segments.size() > 1) {
    summary.notes.push_back("the joints were silent for more than " + print(max_gap) + " s, " +
                            std::to_string(segments.size() - 1 + too_short) + " times; nothing is said across that");
  }
  if (too_short > 0) {
    summary.notes.push_back(std::to_string(too_short) + " parts between silences have fewer than " +
                            std::to_string(kFewestSamples) + " rows, too few to tell an acceleration: they stay NaN");
  }
  return segments;
}

/// sign(q̇) as far as it is known: its mean and variance for a velocity with a standard deviation.
struct Sign {
  double mean;
  double variance;
};
Sign signOf(double velocity, double deviation) {
  const double mean = std::erf(velocity / (std::sqrt(2.0) * std::max(deviation, 1e-12)));
  return {mean, 1.0 - mean * mean};
}

class Recovery {
 public:
  Recovery(const CalibratedArm& arm, const Recording& recording, EffortMetadata meaning, Index rows)
      : model_(arm.robot),
        recording_(recording),
        meaning_(std::move(meaning)),
        shows_drives_(meaning_.side == arm.drives_side && recording.effort.size() > 0),
        n_(model_.size()) {
    bias_ = shows_drives_ ? arm.torque_bias : Eigen::VectorXd::Zero(n_);
    torque = deviation = velocity = acceleration = Eigen::MatrixXd::Constant(rows, n_, kNaN);
    tool = Eigen::MatrixXd::Constant(rows, 7, kNaN);
    noise_squares_ = Eigen::VectorXd::Zero(n_);
  }

  void recover(const std::vector<double>& time, const Segment& segment) {
    const std::vector<double> stamps(time.begin() + static_cast<std::ptrdiff_t>(segment.first),
                                     time.begin() + static_cast<std::ptrdiff_t>(segment.last));
    const auto first = static_cast<Index>(segment.first);
    const auto rows = static_cast<Index>(stamps.size());
    std::vector<SmoothedMotion> motion;
    std::vector<EffortSeries> effort;
    for (Index i = 0; i < n_; ++i) {
      motion.push_back(smoothMotion(stamps, recording_.q.col(i).segment(first, rows)));
      velocity.col(i).segment(first, rows) = motion.back().velocity;
      acceleration.col(i).segment(first, rows) = motion.back().acceleration;
      const double noise = motion.back().measurement_deviation;
      noise_squares_[i] += static_cast<double>(rows) * noise * noise;
      if (recording_.effort.size() > 0) {
        effort.push_back(torqueAtStamps(stamps, recording_.effort.col(i).segment(first, rows), meaning_));
      }
    }
    rows_ += static_cast<double>(rows);
    for (Index k = 0; k < rows; ++k) recoverRow(first + k, k, motion, effort);
  }

  /// Root of the mean square over all segments.
  std::vector<double> encoderNoise() const {
    std::vector<double> noise;
    for (Index i = 0; i < n_; ++i) noise.push_back(rows_ > 0.0 ? std::sqrt(noise_squares_[i] / rows_) : kNaN);
    return noise;
  }

  Eigen::MatrixXd torque, deviation, velocity, acceleration;  // rows x joints
  Eigen::MatrixXd tool;                                       // rows x (force, torque, condition)

 private:
  void recoverRow(Index row, Index k, const std::vector<SmoothedMotion>& motion,
                  const std::vector<EffortSeries>& effort) {
    Eigen::VectorXd q(n_), dq(n_), ddq(n_), variance(n_), velocity_deviation(n_);
    for (Index i = 0; i < n_; ++i) {
      const SmoothedMotion& joint = motion[static_cast<std::size_t>(i)];
      const Eigen::Matrix3d& covariance = joint.covariance[static_cast<std::size_t>(k)];
      q[i] = joint.position[k];
      dq[i] = joint.velocity[k];
      ddq[i] = joint.acceleration[k];
      variance[i] = covariance(2, 2);
      velocity_deviation[i] = std::sqrt(std::max(0.0, covariance(1, 1)));
    }
    Eigen::VectorXd result = model_.inverseDynamics(q, dq, ddq);
    Eigen::MatrixXd inertia = model_.massMatrix(q);
    Eigen::VectorXd uncertain = Eigen::VectorXd::Zero(n_);
    result += bias_;
    if (shows_drives_) addDrives(dq, ddq, velocity_deviation, result, inertia, uncertain);
    if (effort.empty() || !meaning_.includes_gravity) result -= model_.gravity(q);
    for (std::size_t i = 0; i < effort.size(); ++i) {
      result[static_cast<Index>(i)] -= effort[i].torque[k];
      uncertain[static_cast<Index>(i)] += effort[i].variance[k];
    }
    uncertain += inertia.cwiseAbs2() * variance;
    torque.row(row) = result;
    deviation.row(row) = uncertain.cwiseSqrt();
    if (result.allFinite()) explainAtTool(row, q, result);
  }

  void addDrives(const Eigen::VectorXd& dq, const Eigen::VectorXd& ddq, const Eigen::VectorXd& velocity_deviation,
                 Eigen::VectorXd& result, Eigen::MatrixXd& inertia, Eigen::VectorXd& uncertain) const {
    for (Index i = 0; i < n_; ++i) {
      const ArmJoint& joint = model_.description().joints[static_cast<std::size_t>(i)];
      const double deviation = velocity_deviation[i];
      Sign sign = signOf(dq[i], deviation);
      if (joint.friction_velocity > 0.0) {
        sign.mean = std::tanh(dq[i] / joint.friction_velocity);
        sign.variance = std::pow((1.0 - sign.mean * sign.mean) * deviation / joint.friction_velocity, 2);
      }
      result[i] += joint.motor_inertia * ddq[i] + joint.damping * dq[i] + joint.friction * sign.mean;
      inertia(i, i) += joint.motor_inertia;
      uncertain[i] += std::pow(joint.damping * deviation, 2) + joint.friction * joint.friction * sign.variance;
    }
  }

  /// F = (Jᵀ)⁺ τ = (J Jᵀ)⁺ J τ, by the eigenvalues of J Jᵀ.
  void explainAtTool(Index row, const Eigen::VectorXd& q, const Eigen::VectorXd& result) {
    const Eigen::MatrixXd J = model_.jacobian(q);
    const Eigen::Matrix<double, 6, 6> gram = J * J.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> eigen(gram);
    const auto& values = eigen.eigenvalues();  // increasing
    const auto& vectors = eigen.eigenvectors();
    const double largest = std::sqrt(values[5]);
    const double smallest = std::sqrt(std::max(0.0, values[6 - std::min<Index>(n_, 6)]));
    Eigen::Matrix<double, 6, 1> along = vectors.transpose() * (J * result);
    for (Index i = 0; i < 6; ++i) {
      const bool says_something = values[i] > kSingular * kSingular * values[5];
      along[i] = says_something ? along[i] / values[i] : 0.0;
    }
    tool.row(row).head<6>() = (vectors * along).transpose();
    if (smallest > 0.0) tool(row, 6) = largest / smallest;
  }

  RobotModel model_;
  const Recording& recording_;
  const EffortMetadata meaning_;
  const bool shows_drives_;  // the efforts have friction, motor inertia and bias of the drives in them
  const Index n_;
  Eigen::VectorXd bias_;
  Eigen::VectorXd noise_squares_;
  double rows_ = 0.0;
};

std::vector<Column> addedColumns(const RobotDescription& robot) {
  std::vector<Column> columns;
  const auto forEach = [&](const char* prefix, const char* word, const char* unit, const char* sliding, Role role,
                           const char* source) {
    for (const ArmJoint& joint : robot.joints) {
      const bool slides = joint.type == JointType::prismatic;
      columns.push_back({jointColumnName({prefix, word}, joint.name), slides ? sliding : unit, role,
                         Interpolation::linear, std::string(source) + word + "/" + joint.name});
    }
  };
  forEach("dq_", "velocity", "rad/s", "m/s", Role::state, kSmoothed);
  forEach("ddq_", "acceleration", "rad/s^2", "m/s^2", Role::auxiliary, kSmoothed);
  forEach("tau_h_", "torque", "N m", "N", Role::auxiliary, kRecovered);
  forEach("tau_h_std_", "deviation", "N m", "N", Role::auxiliary, kRecovered);
  const std::string source = "human torque at " + robot.tip + " in axes of " + robot.base;
  for (const char* axis : {"x", "y", "z"}) {
    columns.push_back({std::string("tool_f") + axis, "N", Role::auxiliary, Interpolation::linear, source});
  }
  for (const char* axis : {"x", "y", "z"}) {
    columns.push_back({std::string("tool_t") + axis, "N m", Role::auxiliary, Interpolation::linear, source});
  }
  columns.push_back({"tool_condition", "", Role::auxiliary, Interpolation::none, source});
  return columns;
}

}  // namespace

HumanTorqueSummary addHumanTorque(const RobotDescription& robot, Demonstration& demonstration,
                                  const HumanTorqueOptions& options) {
  return addHumanTorque(calibrate(robot, ModelCalibration()), demonstration, options);
}

HumanTorqueSummary addHumanTorque(const CalibratedArm& arm, Demonstration& demonstration,
                                  const HumanTorqueOptions& options) {
  const RobotDescription& robot = arm.robot;
  HumanTorqueSummary summary;
  const EffortMetadata meaning = meaningOf(demonstration, options);
  const Recording recording = readJoints(robot, demonstration, options, summary);
  if (meaning.side != arm.drives_side && (arm.drives_side == "link" || !arm.torque_bias.isZero(0.0))) {
    summary.notes.push_back("the model's biases and friction are those of efforts measured at the " + arm.drives_side +
                            " side; here they were measured at the " + meaning.side + " side, so neither counts");
  }
  Recovery recovery(arm, recording, meaning, recording.q.rows());
  for (const Segment& segment : segmentsOf(demonstration.time, recording.q, options.max_gap, summary)) {
    recovery.recover(demonstration.time, segment);
  }

  const Index n = recording.q.cols();
  const Index at = replaceColumns(addedColumns(robot), demonstration);
  auto added = demonstration.values.rightCols(demonstration.values.cols() - at);
  added << recovery.velocity, recovery.acceleration, recovery.torque, recovery.deviation, recovery.tool;
  demonstration.metadata.effort = meaning;
  summary.encoder_noise = recovery.encoderNoise();
  demonstration.metadata.parameters["encoder_noise"] = summary.encoder_noise;
  summary.largest_torque.assign(static_cast<std::size_t>(n), 0.0);
  for (Index k = 0; k < recovery.torque.rows(); ++k) {
    if (!recovery.torque.row(k).allFinite()) continue;
    ++summary.rows;
    for (Index i = 0; i < n; ++i) {
      double& largest = summary.largest_torque[static_cast<std::size_t>(i)];
      largest = std::max(largest, std::abs(recovery.torque(k, i)));
    }
  }
  return summary;
}

}  // namespace demo_logger
