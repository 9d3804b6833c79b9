#pragma once

#include <deque>
#include <functional>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/simulation/simulated_arm.h"
#include "demo_logger/simulation/simulated_hand.h"
#include "test/simulation/arms.h"

namespace demo_logger {

struct GuidedTick {
  ArmTick arm;
  HandAction hand;  // what it did on seeing this tick
  Eigen::Isometry3d X_base_tool;
};

/// The whole loop without ROS and without waiting: the hand sees the tool each `period` ticks, and what it does reaches
/// the arm `delay` ticks later. Calls `look` after each control tick.
inline void guide(SimulatedArm& arm, SimulatedHand& hand, int period, int delay,
                  const std::function<void(const GuidedTick&)>& look) {
  const RobotModel model(arm.description());
  std::deque<std::pair<int, LinkWrench>> on_the_way;
  for (int k = 0; !hand.finished(); ++k) {
    const Nanoseconds now = kNanosecondsPerSecond + k * kMillisecond;
    while (!on_the_way.empty() && on_the_way.front().first <= k) {
      arm.applyWrench(on_the_way.front().second, now + 200 * kMillisecond, "/hand");
      on_the_way.pop_front();
    }
    GuidedTick tick;
    tick.arm = arm.tick(now, {});
    tick.X_base_tool = model.forwardKinematics(tick.arm.truth.q);
    if (k % period == 0) {
      SeenTool seen;
      seen.X_base_tool = tick.X_base_tool;
      seen.twist = model.jacobian(tick.arm.truth.q) * tick.arm.truth.dq;
      tick.hand = hand.act(now, seen);
      // In the axes of the tool, as a message would say it.
      const Eigen::Matrix3d R_link_base = (arm.description().X_lastlink_tip * tick.X_base_tool.inverse()).linear();
      LinkWrench wrench{static_cast<int>(arm.description().joints.size()) - 1,
                        arm.description().X_lastlink_tip.translation(), R_link_base * tick.hand.wrench.force,
                        R_link_base * tick.hand.wrench.torque, true};
      on_the_way.emplace_back(k + std::max(delay, 1), wrench);
    }
    look(tick);
  }
}

}  // namespace demo_logger
