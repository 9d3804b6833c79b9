#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "arm_motion.h"
#include "demo_logger/robot/robot_description.h"

namespace demo_logger {

/// What the rows of recordings say of an arm's model, thinned out to some hundred a second; efforts are means over the
/// rows around, as measured: a smoother would smear the steps of friction. Rows x joints.
struct TorqueEquations {
  std::vector<std::size_t> recording;  // of each row
  std::vector<std::size_t> range;      // ditto; counts the parts without a silence, of all recordings
  std::vector<double> time;            // [s] in that recording
  Eigen::MatrixXd position, velocity, acceleration;
  Eigen::MatrixXd velocity_deviation;
  Eigen::MatrixXd effort;          // NaN: the joint says nothing here
  Eigen::MatrixXd noise_variance;  // of effort minus model, from the sensors

  Eigen::Index rows() const { return position.rows(); }
};

constexpr double kEquationInterval = 0.01;  // [s] at least, from row to row

/// Appends the rows of one range of recording `index`, whose efforts are raw.
void appendEquations(const RobotDescription& robot, const ArmMotion& motion, std::size_t index,
                     TorqueEquations& equations);

}  // namespace demo_logger
