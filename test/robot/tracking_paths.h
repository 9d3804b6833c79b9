#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "demo_logger/robot/robot_model.h"

namespace demo_logger {

/// Poses of a moving hand, one each dt, and the posture from which an arm follows them.
struct TrackingPath {
  using Poses = std::vector<Eigen::Isometry3d, Eigen::aligned_allocator<Eigen::Isometry3d>>;

  std::string name;
  Poses poses;
  Eigen::VectorXd start;
  bool has_exact_motion = false;  // made from a joint motion within all limits, so that an error of zero is possible
};

struct PathLimits {
  double velocity = 2.5;       // [rad/s or m/s] beside the joints' own
  double acceleration = 10.0;  // [rad/s² or m/s²]
};

/// The paths by which tracking is measured, 10 s long, from rest to rest:
///   nominal       a Lissajous figure of 0.10 to 0.15 m with the orientation swinging by 0.4 to 0.5 rad
///   singular      the tool's way in a joint motion that crosses singular postures of elbow or wrist
///   limits        the tool's way in joint motions that use 99.9 % of each joint's range
///   out of reach  the hand goes 0.9 m outwards and comes back
/// `abrupt` leaves out the gentle start, so that the hand moves from the first moment on.
class TrackingPaths {
 public:
  TrackingPaths(const RobotDescription& robot, double rate, PathLimits limits, bool abrupt = false)
      : model_(robot), rate_(rate), limits_(limits), abrupt_(abrupt) {}

  std::vector<TrackingPath> all() const { return {nominal(), singular(), limits(), outOfReach()}; }

  TrackingPath nominal() const {
    TrackingPath path{"nominal", {}, comfortable(), false};
    const Eigen::Isometry3d X_base_start = model_.forwardKinematics(path.start);
    for (const double s : times()) {
      const Eigen::Vector3d offset(0.15 * std::sin(0.9 * s), 0.12 * std::sin(1.3 * s), 0.10 * std::sin(1.7 * s));
      const Eigen::Vector3d turn(0.5 * std::sin(1.1 * s), 0.4 * std::sin(0.7 * s), 0.45 * std::sin(1.5 * s));
      Eigen::Isometry3d X = X_base_start;
      X.translation() += offset;
      if (turn.norm() > 0.0) X.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * X_base_start.linear();
      path.poses.push_back(X);
    }
    return path;
  }

  /// Every joint swings about a posture whose last bending joints but one are straight: on arms as they are built
  /// (bends alternate with rolls), elbow and wrist pass their singular values several times.
  TrackingPath singular() const {
    Eigen::VectorXd middle = comfortable(), swing = Eigen::VectorXd::Constant(middle.size(), 0.35);
    const int n = static_cast<int>(middle.size());
    for (const int i : {n / 2, n - 2}) {
      middle[i] = 0.0;
      swing[i] = 0.6;
    }
    for (int i = 0; i < n; ++i) {  // a joint that cannot pass 0 comes as near as its limits allow
      const ArmJoint& joint = model_.description().joints[static_cast<std::size_t>(i)];
      middle[i] = std::min(std::max(middle[i], joint.lower + swing[i] + 0.01), joint.upper - swing[i] - 0.01);
    }
    return jointPath("singular", middle, swing, 1.0);
  }

  TrackingPath limits() const {
    const RobotDescription& arm = model_.description();
    Eigen::VectorXd middle(model_.size()), swing(model_.size());
    for (int i = 0; i < model_.size(); ++i) {
      const ArmJoint& joint = arm.joints[static_cast<std::size_t>(i)];
      const bool limited = std::isfinite(joint.lower) && std::isfinite(joint.upper);
      middle[i] = limited ? 0.5 * (joint.lower + joint.upper) : 0.0;
      swing[i] = limited ? 0.999 * 0.5 * (joint.upper - joint.lower) : M_PI;
    }
    return jointPath("limits", middle, swing, 1.0);
  }

  TrackingPath outOfReach() const {
    TrackingPath path{"out of reach", {}, comfortable(), false};
    const Eigen::Isometry3d X_base_start = model_.forwardKinematics(path.start);
    Eigen::Vector3d outwards = X_base_start.translation();
    outwards.z() = 0.2 * outwards.norm();
    outwards.normalize();
    for (const double s : times()) {
      Eigen::Isometry3d X = X_base_start;
      const double half = std::sin(M_PI * s / duration());
      X.translation() += 0.9 * half * half * outwards;
      path.poses.push_back(X);
    }
    return path;
  }

  static double duration() { return 10.0; }

  /// Of some random postures the one furthest from limits and singularities together.
  Eigen::VectorXd comfortable() const {
    const RobotDescription& arm = model_.description();
    std::mt19937_64 generator(17);
    Eigen::VectorXd best;
    double furthest = 0.0;  // [m] of the tips so far
    double best_score = -1.0;
    for (int trial = 0; trial < 3000; ++trial) {
      Eigen::VectorXd q(model_.size());
      double margin = 1.0;
      for (Eigen::Index i = 0; i < q.size(); ++i) {
        const ArmJoint& joint = arm.joints[static_cast<std::size_t>(i)];
        const double lower = std::max(joint.lower, -M_PI), upper = std::min(joint.upper, M_PI);
        q[i] = std::uniform_real_distribution<double>(lower, upper)(generator);
        if (std::isfinite(joint.lower))
          margin = std::min(margin, std::min(q[i] - lower, upper - q[i]) / (upper - lower));
      }
      const Eigen::MatrixXd J = model_.jacobian(q);
      const double smallest = J.jacobiSvd().singularValues().minCoeff();
      const double distance = model_.forwardKinematics(q).translation().norm();
      furthest = std::max(furthest, distance);
      const double score = distance > 0.6 * furthest ? 0.0 : smallest * std::min(margin, 0.25);
      if (score > best_score) {
        best_score = score;
        best = q;
      }
    }
    return best;
  }

 private:
  /// Path parameter [s] of each sample: time, but begun gently over the first second.
  std::vector<double> times() const {
    std::vector<double> result;
    for (int k = 0; k <= static_cast<int>(std::lround(duration() * rate_)); ++k) {
      const double t = k / rate_;
      if (abrupt_) {
        result.push_back(t);
      } else {
        constexpr double kEase = 1.0;  // [s]
        const double u = std::min(t / kEase, 1.0);
        result.push_back(t - kEase * (u - u * u * u + 0.5 * u * u * u * u));  // slope 0 → 1, twice continuous
      }
    }
    return result;
  }

  /// q_i = middle + swing sin(ω_i s), each joint as fast as its limits (and `share` of them) allow, at most 1 rad/s in
  /// ω.
  TrackingPath jointPath(const std::string& name, const Eigen::VectorXd& middle, const Eigen::VectorXd& swing,
                         double share) const {
    TrackingPath path{name, {}, middle, true};
    const RobotDescription& arm = model_.description();
    Eigen::VectorXd omega(middle.size());
    for (Eigen::Index i = 0; i < omega.size(); ++i) {
      const double velocity = std::min(limits_.velocity, arm.joints[static_cast<std::size_t>(i)].velocity_limit);
      // The gentle start adds at most swing ω · 1.8 rad/s² to the acceleration swing ω².
      const double w = std::min({0.6 * velocity / swing[i], 0.6 * std::sqrt(limits_.acceleration / swing[i]), 1.0});
      omega[i] = share * w * (1.0 - 0.07 * static_cast<double>(i % 4));
    }
    for (const double s : times()) {
      Eigen::VectorXd q(middle.size());
      for (Eigen::Index i = 0; i < q.size(); ++i) q[i] = middle[i] + swing[i] * std::sin(omega[i] * s);
      path.poses.push_back(model_.forwardKinematics(q));
    }
    return path;
  }

  RobotModel model_;
  double rate_;
  PathLimits limits_;
  bool abrupt_;
};

}  // namespace demo_logger
