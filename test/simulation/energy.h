#pragma once

#include <cmath>
#include <vector>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/simulation/bullet_arm.h"

namespace demo_logger {

/// Kinetic and potential [J]; the height of every body's centre comes from KDL's poses of its link.
class Energy {
 public:
  explicit Energy(const RobotDescription& arm) : arm_(arm), model_(arm) {
    for (std::size_t i = 0; i < arm.joints.size(); ++i) {
      RobotDescription part = arm;
      part.joints.resize(i + 1);
      part.X_lastlink_tip = Eigen::Isometry3d::Identity();
      links_.emplace_back(part);
    }
  }

  double operator()(const ArmState& state) const {
    double energy = 0.5 * state.dq.dot(model_.massMatrix(state.q) * state.dq);
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const Eigen::VectorXd q = state.q.head(static_cast<Eigen::Index>(i) + 1);
      const BodyInertia& body = arm_.joints[i].body;
      energy -= body.mass * arm_.gravity.dot(links_[i].forwardKinematics(q) * body.center);
      energy += 0.5 * arm_.joints[i].motor_inertia * std::pow(state.dq[static_cast<Eigen::Index>(i)], 2);
    }
    return energy;
  }

 private:
  RobotDescription arm_;
  RobotModel model_;
  std::vector<RobotModel> links_;
};

}  // namespace demo_logger
