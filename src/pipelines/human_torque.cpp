#include "demo_logger/pipelines/human_torque.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "arm_motion.h"
#include "demo_logger/robot/robot_model.h"
#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/not_a_number.h"
#include "demo_logger/trajectory/print.h"
#include "friction_share.h"
#include "joint_columns.h"
#include "joint_notes.h"

namespace demo_logger {
namespace {

using Index = Eigen::Index;

constexpr const char* kRecovered = "human torque/";
constexpr double kSingular = 1e-6;  // of the largest singular value, below which a direction says nothing

/// The efforts that count: none if the arm was compensated for gravity alone.
void decideOnEfforts(const HumanTorqueOptions& options, RecordedJoints& joints, std::vector<std::string>& notes) {
  if (joints.effort.size() > 0) {
    if (!options.gravity_compensated) {
      for (const std::string& joint : joints.without_effort) {
        notes.push_back("joint '" + joint + "' has no efforts: its torque is NaN, and so is the force at the tool");
      }
      return;
    }
    notes.push_back("the arm counts as compensated for gravity, so its recorded efforts are not used");
    joints.effort.resize(0, 0);
    return;
  }
  if (!options.gravity_compensated) {
    throw ConfigurationError(whyNoEfforts(joints, joints.without_effort.front()) +
                             ", without which the human's torque cannot be told from the motor's; if the arm was "
                             "compensated for gravity alone, say so (--gravity-compensated)");
  }
  notes.push_back("no efforts were recorded: the motors count as compensating gravity, and nothing else");
}

class Recovery {
 public:
  Recovery(const CalibratedArm& arm, EffortMetadata meaning, bool has_efforts, Index rows)
      : model_(arm.seenAt(meaning.side)),
        meaning_(std::move(meaning)),
        n_(model_.size()),
        bias_(has_efforts ? arm.biasAt(meaning_.side) : Eigen::VectorXd::Zero(n_)) {
    torque = deviation = velocity = acceleration = Eigen::MatrixXd::Constant(rows, n_, kNaN);
    tool = Eigen::MatrixXd::Constant(rows, 7, kNaN);
    noise_squares_ = Eigen::VectorXd::Zero(n_);
  }

  void recover(const ArmMotion& motion) {
    const auto first = static_cast<Index>(motion.first_row);
    const Index rows = motion.position.rows();
    velocity.middleRows(first, rows) = motion.velocity;
    acceleration.middleRows(first, rows) = motion.acceleration;
    noise_squares_ += static_cast<double>(rows) * motion.noise.cwiseAbs2();
    rows_ += static_cast<double>(rows);
    usual_velocity_ = motion.velocity.colwise().norm() / std::sqrt(static_cast<double>(rows));
    for (Index k = 0; k < rows; ++k) recoverRow(first + k, k, motion);
  }

  /// With the friction that efforts of this side show. Where they were measured behind it, they jump as the
  /// accelerations do, and what smoothing does to both cancels.
  const RobotModel& model() const { return model_; }

  /// Root of the mean square over all segments.
  std::vector<double> encoderNoise() const {
    std::vector<double> noise;
    for (Index i = 0; i < n_; ++i) noise.push_back(rows_ > 0.0 ? std::sqrt(noise_squares_[i] / rows_) : kNaN);
    return noise;
  }

  Eigen::MatrixXd torque, deviation, velocity, acceleration;  // rows x joints
  Eigen::MatrixXd tool;                                       // rows x (force, torque, condition)

 private:
  void recoverRow(Index row, Index k, const ArmMotion& motion) {
    const bool has_efforts = motion.effort.size() > 0;
    const Eigen::VectorXd q = motion.position.row(k);
    const Eigen::VectorXd dq = motion.velocity.row(k);
    const Eigen::VectorXd ddq = motion.acceleration.row(k);
    Eigen::VectorXd result = model_.inverseDynamics(q, dq, ddq) + bias_;
    Eigen::MatrixXd inertia = model_.massMatrix(q);
    Eigen::VectorXd uncertain = Eigen::VectorXd::Zero(n_);
    addDrives(dq, ddq, motion.velocity_variance.row(k).cwiseSqrt(), result, inertia, uncertain);
    if (!has_efforts || !meaning_.includes_gravity) result -= model_.gravity(q);
    if (has_efforts) {
      result -= motion.effort.row(k).transpose();
      uncertain += motion.effort_variance.row(k).transpose();
    }
    uncertain += inertia.cwiseAbs2() * motion.acceleration_variance.row(k).transpose();
    torque.row(row) = result;
    deviation.row(row) = uncertain.cwiseSqrt();
    if (result.allFinite()) explainAtTool(row, q, result);
  }

  void addDrives(const Eigen::VectorXd& dq, const Eigen::VectorXd& ddq, const Eigen::VectorXd& velocity_deviation,
                 Eigen::VectorXd& result, Eigen::MatrixXd& inertia, Eigen::VectorXd& uncertain) const {
    for (Index i = 0; i < n_; ++i) {
      const ArmJoint& joint = model_.description().joints[static_cast<std::size_t>(i)];
      const double deviation = velocity_deviation[i];
      const FrictionShare share = frictionShare(dq[i], deviation, joint.friction_velocity, usual_velocity_[i]);
      result[i] += joint.motor_inertia * ddq[i] + joint.damping * dq[i] + joint.friction * share.mean;
      inertia(i, i) += joint.motor_inertia;
      uncertain[i] += std::pow(joint.damping * deviation, 2) + joint.friction * joint.friction * share.variance;
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
  const EffortMetadata meaning_;
  const Index n_;
  const Eigen::VectorXd bias_;
  Eigen::VectorXd noise_squares_;
  Eigen::VectorXd usual_velocity_;  // of each joint, within the range
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
  const EffortMetadata meaning = options.effort.value_or(demonstration.metadata.effort);
  validate(meaning);
  RecordedJoints joints = readJoints(robot, demonstration);
  decideOnEfforts(options, joints, summary.notes);
  summary.notes.insert(summary.notes.end(), joints.notes.begin(), joints.notes.end());
  noteMissingPositions(robot, joints.position, summary.notes);
  noteMovingJointsBesideTheChain(robot, demonstration, summary.notes);
  notePositionsBeyondLimits(robot, demonstration.time, joints.position, summary.notes);
  const bool has_efforts = joints.effort.size() > 0;
  if (arm.knowsOnlyTheOtherSide(meaning.side)) {
    summary.notes.push_back("the model's biases and friction are those of efforts measured at the " + arm.drives_side +
                            " side; here they were measured at the " + meaning.side + " side, so neither counts");
  }
  Recovery recovery(arm, meaning, has_efforts, joints.position.rows());
  for (const RowRange& range :
       rangesWithoutSilence(demonstration.time, joints.position, options.max_gap, summary.notes)) {
    recovery.recover(
        smoothArm(demonstration.time, joints, range, meaning, MeasuredEfforts::smoothed, &recovery.model()));
  }

  const Index n = joints.position.cols();
  const Index at = replaceColumns(addedColumns(robot), demonstration);
  auto added = demonstration.values.rightCols(demonstration.values.cols() - at);
  added << recovery.velocity, recovery.acceleration, recovery.torque, recovery.deviation, recovery.tool;
  demonstration.metadata.effort = meaning;
  summary.encoder_noise = recovery.encoderNoise();
  demonstration.metadata.parameters["encoder_noise"] = summary.encoder_noise;
  summary.largest_torque.assign(static_cast<std::size_t>(n), kNaN);
  for (Index k = 0; k < recovery.torque.rows(); ++k) {
    if (recovery.torque.row(k).allFinite()) ++summary.rows;
    for (Index i = 0; i < n; ++i) {
      double& largest = summary.largest_torque[static_cast<std::size_t>(i)];
      largest = std::fmax(largest, std::abs(recovery.torque(k, i)));  // passes over NaN
    }
  }
  return summary;
}

}  // namespace demo_logger
