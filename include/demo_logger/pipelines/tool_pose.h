#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "demo_logger/recording/derived_columns.h"
#include "demo_logger/robot/robot_description.h"
#include "demo_logger/trajectory/demonstration.h"

namespace demo_logger {

/// The pose of the tip in the base frame, X_base_tip(q), as columns of its own:
///   ee_x ee_y ee_z [m], ee_qx ee_qy ee_qz ee_qw: unit quaternion, scalar last
/// q and −q are the same orientation: the sign is chosen so that each row's quaternion is on the side of the row
/// before, and qw ≥ 0 in the first, so that the columns are continuous. NaN where a joint of the chain has no position.
class ToolPose : public DerivedColumns {
 public:
  explicit ToolPose(const RobotDescription& robot);
  ~ToolPose() override;

  /// The joints are found by the source of their columns, joint_states/position/<joint>, or where none is stated by
  /// their names, q_<joint>. A chain whose joints are not all recorded gets no columns.
  std::vector<Column> open(const std::vector<Column>& recorded) override;
  void append(Row& row) override;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Appends the tool pose to a recording, in place of columns of these names that it has. Throws ConfigurationError
/// naming the first joint without a position. Returns in how many rows there is no pose.
std::size_t addToolPose(const RobotDescription& robot, Demonstration& demonstration);

}  // namespace demo_logger
