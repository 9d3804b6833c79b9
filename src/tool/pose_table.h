#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "demo_logger/robot/robot_description.h"
#include "src/tool/row_notes.h"

namespace demo_logger {

/// Poses of the tip, row by row, as `ik` takes them.
struct PoseTable {
  using Poses = std::vector<Eigen::Isometry3d, Eigen::aligned_allocator<Eigen::Isometry3d>>;

  std::vector<double> time;            // [s], empty if the table has no such column
  Poses poses;                         // NaN where a value is missing or the quaternion zero
  std::vector<Eigen::VectorXd> seeds;  // empty without q0_… columns
};

/// Reads the columns x, y, z [m], qx, qy, qz, qw (or ee_x … ee_qw, as `kinematics` writes them), and if they are there
/// time [s] and q0_<joint> [rad or m] for each joint of the arm. Other columns are left alone. Quaternions that are not
/// of length 1 are made so; what was amiss in rows goes into `notes`. Throws FileError for a table without the columns.
PoseTable readPoseTable(const std::filesystem::path& file, const RobotDescription& arm, RowNotes& notes);

}  // namespace demo_logger
