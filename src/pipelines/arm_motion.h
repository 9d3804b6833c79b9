#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "demo_logger/robot/robot_description.h"
#include "demo_logger/robot/robot_model.h"
#include "demo_logger/trajectory/demonstration.h"

namespace demo_logger {

/// What a recording holds of an arm, rows x joints; NaN where it is missing.
struct RecordedJoints {
  Eigen::MatrixXd position;
  Eigen::MatrixXd effort;                   // empty: no efforts of any joint
  std::vector<std::string> without_effort;  // the joints that have none
  bool has_effort_columns = false;          // though they may hold nothing
  std::vector<std::string> notes;           // of values that no arm has, which count as missing
};

/// Throws ConfigurationError naming the first joint without a column of positions, or with one in another unit.
RecordedJoints readJoints(const RobotDescription& robot, const Demonstration& demonstration);

/// "no column `tau_elbow` with efforts of joint 'elbow'", or that there is one which holds none.
std::string whyNoEfforts(const RecordedJoints& joints, const std::string& joint);

/// Rows [first, last) without a silence of the joints.
struct RowRange {
  std::size_t first;
  std::size_t last;
};

/// Where every joint has a position now and again, and often enough to be smoothed; `notes` says where not.
std::vector<RowRange> rangesWithoutSilence(const std::vector<double>& time, const Eigen::MatrixXd& position,
                                           double max_gap, std::vector<std::string>& notes);

/// The motion of an arm within one such range, and its motors' torques, at the rows' stamps. Rows x joints.
struct ArmMotion {
  std::size_t first_row = 0;
  std::vector<double> time;  // of the recording
  Eigen::MatrixXd position, velocity, acceleration;
  Eigen::MatrixXd velocity_variance, acceleration_variance;
  Eigen::MatrixXd effort, effort_variance;  // what the efforts say of the torque at the stamps; empty without efforts
  Eigen::VectorXd noise;                    // per joint, standard deviation of a measured position
};
/// Measured efforts are smoothed as the positions are, or left as they were measured (with no variance then). With the
/// model of an arm whose joints have friction, accelerations jump where that holds a joint or turns round.
enum class MeasuredEfforts { smoothed, raw };
ArmMotion smoothArm(const std::vector<double>& time, const RecordedJoints& joints, const RowRange& range,
                    const EffortMetadata& meaning, MeasuredEfforts efforts = MeasuredEfforts::smoothed,
                    const RobotModel* model = nullptr);

/// sign(q̇) as far as it is known: its mean and variance for a velocity with a standard deviation. With a friction
/// velocity v > 0, tanh(q̇ / v) instead.
struct VelocitySign {
  double mean;
  double variance;
};
VelocitySign signOf(double velocity, double deviation, double friction_velocity);

}  // namespace demo_logger
