#include "src/tool/pose_table.h"

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

#include "demo_logger/formats/column_names.h"
#include "demo_logger/formats/csv_reader.h"
#include "demo_logger/trajectory/error.h"

namespace demo_logger {
namespace {

constexpr double kShortest = 1e-6;  // length of a quaternion below which its direction means nothing
constexpr double kUnit = 1e-3;      // by which a length may differ from 1 without a word: a few printed digits
constexpr std::array<const char*, 7> kPose = {"x", "y", "z", "qx", "qy", "qz", "qw"};

std::array<std::size_t, 7> findPose(const CsvReader& reader, const std::filesystem::path& file) {
  const std::string prefix = !reader.find("x") && reader.find("ee_x") ? "ee_" : "";
  std::array<std::size_t, 7> pose{};
  for (std::size_t i = 0; i < pose.size(); ++i) {
    const auto column = reader.find(prefix + kPose[i]);
    if (!column) {
      throw FileError(file.string() + ":1: there is no column `" + prefix + kPose[i] +
                      "`, expected the pose of the tip as x, y, z [m], qx, qy, qz, qw");
    }
    pose[i] = *column;
  }
  return pose;
}

/// By the joint's own name or the portable one that files use.
std::vector<std::size_t> findSeed(const CsvReader& reader, const std::filesystem::path& file,
                                  const RobotDescription& arm) {
  std::vector<std::string> originals;
  for (const std::string& joint : arm.jointNames()) originals.push_back("q0_" + joint);
  const std::vector<std::string> portable = makePortable(originals).names;
  std::vector<std::size_t> seed;
  std::string missing;
  for (std::size_t i = 0; i < originals.size(); ++i) {
    auto column = reader.find(originals[i]);
    if (!column) column = reader.find(portable[i]);
    if (column) {
      seed.push_back(*column);
    } else if (missing.empty()) {
      missing = portable[i];
    }
  }
  if (!seed.empty() && !missing.empty()) {
    throw FileError(file.string() + ":1: there is no column `" + missing + "`, expected a q0_ column for each of the " +
                    std::to_string(originals.size()) + " joints of robot '" + arm.name + "', or none");
  }
  return seed;
}

Eigen::Isometry3d toPose(const std::vector<double>& row, const std::array<std::size_t, 7>& at, std::size_t line,
                         RowNotes& notes) {
  Eigen::Isometry3d X_base_tip = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d position(row[at[0]], row[at[1]], row[at[2]]);
  const Eigen::Quaterniond quaternion(row[at[6]], row[at[3]], row[at[4]], row[at[5]]);
  const double length = quaternion.coeffs().stableNorm();
  if (!position.allFinite() || !quaternion.coeffs().allFinite() || length < kShortest) {
    notes.add("pose", line,
              length < kShortest ? "the quaternion is zero, expected one of length 1; the row is not solved"
                                 : "the pose holds a value that is not a finite number; the row is not solved");
    X_base_tip.affine().setConstant(std::numeric_limits<double>::quiet_NaN());
    return X_base_tip;
  }
  if (std::abs(length - 1.0) > kUnit) {
    std::ostringstream sentence;
    sentence << "the quaternion has length " << length << ", expected 1; it is normalised";
    notes.add("quaternion", line, sentence.str());
  }
  X_base_tip.translation() = position;
  X_base_tip.linear() = Eigen::Quaterniond(quaternion.coeffs() / length).normalized().toRotationMatrix();
  return X_base_tip;
}

Eigen::VectorXd toSeed(const std::vector<double>& row, const std::vector<std::size_t>& at, const RobotDescription& arm,
                       std::size_t line, RowNotes& notes) {
  Eigen::VectorXd q(static_cast<Eigen::Index>(at.size()));
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double value = row[at[i]];
    q[static_cast<Eigen::Index>(i)] = value;
    const ArmJoint& joint = arm.joints[i];
    if (!std::isfinite(value)) {
      notes.add("seed", line, "the seed of joint '" + joint.name + "' is not a finite number; the row is not solved");
    } else if (value < joint.lower || value > joint.upper) {
      std::ostringstream sentence;
      sentence << "the seed of joint '" << joint.name << "' is " << value << ", out of its limits " << joint.lower
               << " to " << joint.upper << "; the nearest limit is taken";
      notes.add("seed_limits", line, sentence.str());
    }
  }
  return q;
}

}  // namespace

PoseTable readPoseTable(const std::filesystem::path& file, const RobotDescription& arm, RowNotes& notes) {
  CsvReader reader(file, CsvExpectation{{}, false, {"status"}});
  const std::array<std::size_t, 7> pose = findPose(reader, file);
  const std::vector<std::size_t> seed = findSeed(reader, file, arm);
  const std::optional<std::size_t> time = reader.find("time");
  PoseTable table;
  std::vector<double> row;
  while (reader.next(row)) {
    if (time) table.time.push_back(row[*time]);
    table.poses.push_back(toPose(row, pose, reader.line(), notes));
    if (!seed.empty()) table.seeds.push_back(toSeed(row, seed, arm, reader.line(), notes));
  }
  return table;
}

}  // namespace demo_logger
