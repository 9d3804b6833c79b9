#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "demo_logger/robot/robot_description.h"
#include "demo_logger/trajectory/demonstration.h"

namespace demo_logger {

/// Of joints beside the chain that move although the model holds them still.
void noteMovingJointsBesideTheChain(const RobotDescription& robot, const Demonstration& demonstration,
                                    std::vector<std::string>& notes);

/// Of joints that leave no row with positions of all.
void noteMissingPositions(const RobotDescription& robot, const Eigen::MatrixXd& position,
                          std::vector<std::string>& notes);

/// Of joints whose positions (rows x joints [rad or m]) no such arm can have: a wrong reading, another unit.
void notePositionsBeyondLimits(const RobotDescription& robot, const std::vector<double>& time,
                               const Eigen::MatrixXd& position, std::vector<std::string>& notes);

}  // namespace demo_logger
