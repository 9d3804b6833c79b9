#pragma once

#include <array>
#include <vector>

#include "arm_kinematics.h"
#include "joint_ranges.h"

namespace demo_logger {

/// Postures all over the joint space with the tip poses they give: where to begin for a target that the seed does not
/// lead to.
class PostureTable {
 public:
  static constexpr int kPostures = 512;
  static constexpr int kNearest = 12;

  PostureTable(const ArmKinematics& kinematics, const JointRanges& ranges);

  class Nearest {
   public:
    /// The one with `rank` 0, 1, … in `q`; false beyond the last.
    bool posture(int rank, JointVector& q) const;

    /// Those from rank `from` on, by their largest joint move from `seed`.
    void sortByMove(int from, const JointVector& seed);

   private:
    friend class PostureTable;
    const PostureTable* table_ = nullptr;
    int count_ = 0;
    std::array<int, kNearest> entries_{};
  };

  /// By ‖per_metre Δp‖² + (rotation between the orientations)², nearest first.
  Nearest nearest(const RigidPose& target, double per_metre) const;

 private:
  struct Entry {
    Eigen::Vector3d position;
    Eigen::Vector4d orientation;  // unit quaternion
    JointVector q;
  };
  JointRanges ranges_;
  std::vector<Entry> entries_;
};

}  // namespace demo_logger
