#include "posture_table.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace demo_logger {
namespace {

constexpr std::uint64_t kKey = 0x7461626c65U;  // any number, another than a caller's restart seed

}  // namespace

PostureTable::PostureTable(const ArmKinematics& kinematics, const JointRanges& ranges)
    : ranges_(ranges), entries_(kPostures) {
  RigidPose pose;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    Entry& entry = entries_[i];
    entry.q.resize(kinematics.size());
    ranges.randomPosture(kKey, i, entry.q);
    kinematics.forward(entry.q, pose);
    entry.position = pose.p;
    entry.orientation = Eigen::Quaterniond(pose.R).coeffs();
  }
}

PostureTable::Nearest PostureTable::nearest(const RigidPose& target, double per_metre) const {
  const Eigen::Vector4d orientation = Eigen::Quaterniond(target.R).coeffs();
  std::array<double, kNearest> distances{};  // of those found so far, ascending
  Nearest nearest;
  nearest.table_ = this;
  for (int i = 0; i < kPostures; ++i) {
    const Entry& entry = entries_[static_cast<std::size_t>(i)];
    // 8 (1 − |cos(θ/2)|) is θ² for small angles θ and 8 for half a turn: near enough, without an arc cosine.
    const double distance = per_metre * per_metre * (entry.position - target.p).squaredNorm() +
                            8.0 * (1.0 - std::abs(entry.orientation.dot(orientation)));
    auto rank = static_cast<std::size_t>(nearest.count_);
    if (nearest.count_ == kNearest) {
      if (distance >= distances.back()) continue;
      --rank;
    } else {
      ++nearest.count_;
    }
    for (; rank > 0 && distances[rank - 1] > distance; --rank) {
      distances[rank] = distances[rank - 1];
      nearest.entries_[rank] = nearest.entries_[rank - 1];
    }
    distances[rank] = distance;
    nearest.entries_[rank] = i;
  }
  return nearest;
}

void PostureTable::Nearest::sortByMove(int from, const JointVector& seed) {
  if (from >= count_) return;
  const auto move = [&](int entry) {
    return table_->ranges_.largestMove(seed, table_->entries_[static_cast<std::size_t>(entry)].q);
  };
  std::sort(entries_.begin() + from, entries_.begin() + count_, [&](int a, int b) { return move(a) < move(b); });
}

bool PostureTable::Nearest::posture(int rank, JointVector& q) const {
  if (rank >= count_) return false;
  q = table_->entries_[static_cast<std::size_t>(entries_[static_cast<std::size_t>(rank)])].q;
  return true;
}

}  // namespace demo_logger
