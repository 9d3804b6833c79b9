#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <random>

#include "demo_logger/robot/robot_model.h"
#include "test/robot/subjects.h"

namespace demo_logger {

/// How far a point is from all positions that the tip can take within joint limits: least squares on the position
/// alone, by KDL, from the posture found last and from random ones. An upper bound that many starts make tight.
class ReachableDistance {
 public:
  explicit ReachableDistance(const RobotDescription& arm) : arm_(arm), model_(arm) {
    nearest_ = randomPosture(arm, generator_);
  }

  /// [m]
  double to(const Eigen::Vector3d& point) {
    Eigen::VectorXd best = nearest_;
    double least = descend(point, best);
    const int starts = ++calls_ % 20 == 1 ? 20 : 2;
    for (int start = 0; start < starts && least > 1e-5; ++start) {
      Eigen::VectorXd q = randomPosture(arm_, generator_);
      const double distance = descend(point, q);
      if (distance < least) {
        least = distance;
        best = q;
      }
    }
    nearest_ = best;
    return least;
  }

 private:
  double descend(const Eigen::Vector3d& point, Eigen::VectorXd& q) {
    Eigen::VectorXd best = q;
    double least = 1e9;
    for (int i = 0; i < 60; ++i) {
      const Eigen::Vector3d error = point - model_.forwardKinematics(q).translation();
      if (error.norm() < least) {
        least = error.norm();
        best = q;
      }
      if (least < 1e-6) break;
      const Eigen::MatrixXd J = model_.jacobian(q).topRows(3);
      Eigen::Matrix3d A = J * J.transpose();
      A.diagonal().array() += 1e-9 + 0.2 * error.norm();
      Eigen::VectorXd step = J.transpose() * A.ldlt().solve(error);
      step *= std::min(1.0, 1.0 / std::max(1e-12, step.cwiseAbs().maxCoeff()));
      q += step;
      for (Eigen::Index k = 0; k < q.size(); ++k) {
        const ArmJoint& joint = arm_.joints[static_cast<std::size_t>(k)];
        q[k] = std::clamp(q[k], joint.lower, joint.upper);
      }
    }
    q = best;
    return least;
  }

  const RobotDescription& arm_;
  RobotModel model_;
  std::mt19937_64 generator_{5};
  Eigen::VectorXd nearest_;
  int calls_ = 0;
};

}  // namespace demo_logger
