#include <algorithm>
#include <cmath>
#include <limits>

#include "check_parts.h"

namespace demo_logger {
namespace {

constexpr double kFullTurn = 6.283185307179586;

// Position and velocity of one joint: columns q_<joint> and dq_<joint>.
struct JointColumns {
  std::string name;
  std::string unit;  // of the position
  Eigen::Index position = 0;
  Eigen::Index velocity = 0;
  double resolution = 0.0;  // smallest step between two rows that is not zero
};

std::vector<JointColumns> findJoints(const Demonstration& demonstration) {
  std::map<std::string, Eigen::Index> index;
  for (std::size_t i = 0; i < demonstration.columns.size(); ++i) {
    index[demonstration.columns[i].name] = static_cast<Eigen::Index>(i);
  }
  std::vector<JointColumns> joints;
  for (const auto& column : demonstration.columns) {
    const auto velocity = index.find("d" + column.name);
    if (column.name.rfind("q_", 0) != 0 || velocity == index.end()) {
      continue;
    }
    JointColumns joint{column.name.substr(2), column.unit.empty() ? "rad" : column.unit, index[column.name],
                       velocity->second, std::numeric_limits<double>::infinity()};
    const auto position = demonstration.values.col(joint.position);
    for (Eigen::Index row = 1; row < demonstration.values.rows(); ++row) {
      const double step = std::abs(position(row) - position(row - 1));
      if (step > 0.0) {
        joint.resolution = std::min(joint.resolution, step);
      }
    }
    joints.push_back(joint);
  }
  return joints;
}

// All joints stand exactly where they stood a row before, although one of them moves by more than its sensor resolves.
bool repeatsInMotion(const Demonstration& demonstration, const std::vector<JointColumns>& joints, std::size_t row,
                     const CheckLimits& limits) {
  const auto now = static_cast<Eigen::Index>(row);
  const double period = demonstration.time[row] - demonstration.time[row - 1];
  bool moves = false;
  for (const JointColumns& joint : joints) {
    const double position = demonstration.values(now, joint.position);
    const double before = demonstration.values(now - 1, joint.position);
    if (position != before && !(std::isnan(position) && std::isnan(before))) {
      return false;
    }
    const double speed = std::min(std::abs(demonstration.values(now, joint.velocity)),
                                  std::abs(demonstration.values(now - 1, joint.velocity)));
    const double resolved = std::isfinite(joint.resolution) ? 2.0 * joint.resolution : 0.0;
    moves = moves || (speed > limits.still_speed && speed * period > resolved);
  }
  return moves;
}

void checkRepetition(const Demonstration& demonstration, const std::vector<JointColumns>& joints,
                     const CheckLimits& limits, Findings& findings) {
  const std::vector<double>& time = demonstration.time;
  std::size_t repeated = 0;
  double first = 0.0;
  std::size_t start = 0;  // of the present run of equal rows
  for (std::size_t row = 1; row <= time.size(); ++row) {
    if (row < time.size() && repeatsInMotion(demonstration, joints, row, limits)) {
      if (repeated++ == 0) {
        first = time[row];
      }
      continue;
    }
    const double lasted = time[row - 1] - time[start];
    if (lasted > limits.frozen) {
      findings.add("frozen", Severity::error,
                   "the joint positions stand still for " + formatDuration(lasted) + " " + formatInstant(time[start]) +
                       " although the velocities say that the arm moves; the driver repeats an old state.");
    }
    start = row;
  }
  const double share = static_cast<double>(repeated) / static_cast<double>(time.size());
  if (share > limits.tolerated_share) {
    findings.add("repeated_rows", Severity::warning,
                 formatShare(share) +
                     " of the rows repeat the joint positions of the row before while the arm moves, "
                     "first " +
                     formatInstant(first) +
                     "; the driver publishes faster than the controller updates, so differences of positions alternate "
                     "between zero and double.");
  }
}

// Joints whose velocity is always zero although they move are taken out: it says nothing about their positions.
void checkVelocities(const Demonstration& demonstration, std::vector<JointColumns>& joints, const CheckLimits& limits,
                     Findings& findings) {
  std::vector<std::string> names;
  double farthest = 0.0;
  const auto is_without_velocity = [&](const JointColumns& joint) {
    const auto positions = spreadOf(demonstration.values, joint.position);
    const auto velocities = spreadOf(demonstration.values, joint.velocity);
    if (!positions || !velocities || velocities->min != 0.0 || velocities->max != 0.0 ||
        positions->max - positions->min < limits.still_speed) {
      return false;
    }
    names.push_back("dq_" + joint.name);
    farthest = std::max(farthest, positions->max - positions->min);
    return true;
  };
  joints.erase(std::remove_if(joints.begin(), joints.end(), is_without_velocity), joints.end());
  if (!names.empty()) {
    findings.add("no_velocity", Severity::warning,
                 formatNames(names) + (names.size() == 1 ? " is" : " are") +
                     " 0 in every row although the positions move by up to " + formatNumber(farthest) +
                     "; the driver fills in zeros. Differentiate the positions instead of using the velocities.");
  }
}

struct Jump {
  const JointColumns* joint = nullptr;
  double step = 0.0;
  double plausible = 0.0;
  double speed = 0.0;
};

// The joints that move farther within one row than they can, at their own velocities.
std::vector<Jump> jumpsInto(std::size_t row, const Demonstration& demonstration,
                            const std::vector<JointColumns>& joints, const CheckSummary& summary,
                            const CheckLimits& limits) {
  std::vector<Jump> jumps;
  const auto now = static_cast<Eigen::Index>(row);
  // Stamps that jitter come closer than the samples were taken; they are no faster motion.
  const double period = std::max(demonstration.time[row] - demonstration.time[row - 1], summary.median_period);
  for (const JointColumns& joint : joints) {
    Jump jump;
    jump.joint = &joint;
    jump.step = demonstration.values(now, joint.position) - demonstration.values(now - 1, joint.position);
    jump.speed = std::max(std::abs(demonstration.values(now, joint.velocity)),
                          std::abs(demonstration.values(now - 1, joint.velocity)));
    jump.plausible = (2.0 * jump.speed + limits.joint_speed) * (period + limits.stamp_slack) +
                     2.0 * (std::isfinite(joint.resolution) ? joint.resolution : 0.0);
    if (std::abs(jump.step) > jump.plausible) {  // not where a value is missing
      jumps.push_back(jump);
    }
  }
  return jumps;
}

// The first joint's figures stand for all that jump together.
std::string tell(const std::vector<Jump>& jumps, double period, double time) {
  std::vector<std::string> names;
  names.reserve(jumps.size());
  for (const Jump& jump : jumps) {
    names.push_back(jump.joint->name);
  }
  const Jump& first = jumps.front();
  const std::string& unit = first.joint->unit;
  const bool wraps = unit == "rad" && std::abs(std::abs(first.step) - kFullTurn) < first.plausible;
  return "joint " + formatNames(names) + (names.size() == 1 ? " jumps" : " jump") + " by " + formatNumber(first.step) +
         " " + unit + " within " + formatDuration(period) + " " + formatInstant(time) + ", expected at most " +
         formatNumber(first.plausible) + " " + unit + " at a velocity of " + formatNumber(first.speed) + " " + unit +
         "/s; " +
         (wraps ? "the angle wraps around by a full turn." : "was the encoder reset, or are two robots' states mixed?");
}

void checkJumps(const Demonstration& demonstration, const std::vector<JointColumns>& joints,
                const CheckSummary& summary, const CheckLimits& limits, Findings& findings) {
  const std::vector<double>& time = demonstration.time;
  for (std::size_t row = 1; row < time.size(); ++row) {
    const std::vector<Jump> jumps = jumpsInto(row, demonstration, joints, summary, limits);
    if (!jumps.empty()) {
      findings.add("jump", Severity::error, tell(jumps, time[row] - time[row - 1], time[row]));
    }
  }
}

}  // namespace

void checkMotion(const Demonstration& demonstration, const CheckSummary& summary, const CheckLimits& limits,
                 Findings& findings) {
  std::vector<JointColumns> joints = findJoints(demonstration);
  if (demonstration.time.size() < 2) {
    return;
  }
  checkVelocities(demonstration, joints, limits, findings);
  checkRepetition(demonstration, joints, limits, findings);
  checkJumps(demonstration, joints, summary, limits, findings);
}

}  // namespace demo_logger
