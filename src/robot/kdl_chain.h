#pragma once

#include <Eigen/Geometry>
#include <kdl/chain.hpp>

#include "demo_logger/robot/robot_description.h"

namespace demo_logger {

KDL::Vector toKdl(const Eigen::Vector3d& v);
KDL::Frame toKdl(const Eigen::Isometry3d& X);

/// One segment per joint of the arm, with its lumped body, and a last one without joint or mass that ends at the tip.
/// KDL's solvers keep a reference to their chain, and its joints remember their last pose: one chain for one thread.
KDL::Chain makeKdlChain(const RobotDescription& description);

}  // namespace demo_logger
