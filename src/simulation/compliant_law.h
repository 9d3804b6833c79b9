#pragma once

#include <Eigen/Core>

#include "demo_logger/channels/impedance.h"
#include "demo_logger/robot/robot_model.h"
#include "demo_logger/simulation/bullet_arm.h"

namespace demo_logger {

class Snapshot;

/// The law of the compliant modes with what it remembers: its gains, where the arm was when it was engaged, and a
/// torque that it took over.
class CompliantLaw {
 public:
  /// Motors go on from `torque` of the last tick [N m or N]: what that is more than this law's own fades to nothing in
  /// so many ticks. Empty: there is nothing to take over.
  void engage(const ImpedanceGains& gains, const Eigen::VectorXd& torque, int fading_ticks);
  /// The arm was set elsewhere: that is where it rests from now on.
  void reengage() { engage(gains_, {}, 1); }

  /// Once per tick. The first one after engaging takes q_ref.
  Eigen::VectorXd torque(const RobotModel& model, const ArmState& state);

  const Eigen::VectorXd& reference() const { return q_ref_; }

  void exchange(Snapshot& snapshot);

 private:
  ImpedanceGains gains_;
  Eigen::VectorXd q_ref_;   // [rad or m]; empty: not taken yet
  Eigen::VectorXd before_;  // torque of the last tick of another law; empty: none
  Eigen::VectorXd excess_;  // of it over this law
  int fading_ticks_ = 1;
  int faded_ticks_ = 0;
};

}  // namespace demo_logger
