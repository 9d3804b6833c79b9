#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/simulation/simulated_human.h"
#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

/// What a hand shows a compliant arm.
///   reach  to a place on one side, over to the other, and back; rests at each
///   arc    over to the other side in one sweep, and back below: each movement begins before the last one ends
///   peg    to a place above a hole, a fine adjustment, straight down into it, out again and back
struct HandTask {
  std::vector<Waypoint> waypoints;
  double overlap = 0.0;  // of a movement's duration, in which the next one is on its way already; 0: rests between them
};
/// Throws ConfigurationError listing the tasks there are.
HandTask handTask(const std::string& name);
std::vector<std::string> handTaskNames();

struct SimulatedHandConfiguration {
  HandTask task = handTask("reach");
  std::uint64_t seed = 1;
  double stiffness = 500.0;         // [N/m]
  double damping = 40.0;            // [N s/m]
  double turning_stiffness = 12.0;  // [N m/rad]
  double turning_damping = 0.15;    // [N m s/rad]
  double largest_force = 80.0;      // [N]
  double largest_torque = 6.0;      // [N m]
  double grasp_ramp = 0.25;         // [s] to close around the tool
  double release_ramp = 0.12;       // [s] to let go of it
  double tremor = 0.3;              // [N] amplitude along each axis; a thirtieth of it [N m] about each
};

/// The tool as the hand sees it, in base axes.
struct SeenTool {
  Eigen::Isometry3d X_base_tool = Eigen::Isometry3d::Identity();
  Eigen::Matrix<double, 6, 1> twist = Eigen::Matrix<double, 6, 1>::Zero();  // v of its origin [m/s], ω [rad/s]
};

struct HandAction {
  TipWrench wrench;  // upon the tool, at its origin
  bool holds = false;
  bool start_pressed = false;  // the recorder's buttons
  bool stop_pressed = false;
};

/// A hand that guides the tool along a task: a spring and a damper in six dimensions between where it means the tool to
/// be and where it sees it,
///   f = c(t) (k (p_plan − p) + d (v_plan − v)) + tremor,   m = c(t) (k_r log(R_plan Rᵀ) + d_r (ω_plan − ω)) + tremor,
/// c from 0 to 1 as it grasps and back as it lets go. Way-points are drawn anew within a centimetre from the seed and
/// reached in the minimum-jerk way; tremor is three sines of 7 to 11 Hz on each axis. The wrench depends on the time
/// and on what is seen alone, not on how often the hand is asked.
///
/// What is seen T late makes of the spring a damper of −k T, and of the damper a loop of its own, which swings when
/// d T reaches 1.5 times the mass that is moved. So d is at least k · 10 ms (else refused), and light wrists bound it
/// from above. The defaults suit the demo arm: calm with T = 6 ms if it has no friction, with 20 ms if it has its own.
/// A tool that flings about (15 rad/s, 3 m/s, or 0.3 m off) slips out of the hand for good.
///
/// The course: hands off for a second (start button at 0.1 s) · grasp, a quarter of a second of rest · the task · half
/// a second to settle · release · hands off for 1.5 s, stop button · end half a second later.
class SimulatedHand {
 public:
  /// Throws ConfigurationError naming the field.
  explicit SimulatedHand(const SimulatedHandConfiguration& configuration);
  ~SimulatedHand();
  SimulatedHand(SimulatedHand&&) noexcept;
  SimulatedHand& operator=(SimulatedHand&&) noexcept;

  /// What it does at `now`, seeing `tool`. The course begins with the first call; the task starts from where the tool
  /// is when it is grasped.
  HandAction act(Nanoseconds now, const SeenTool& tool);

  bool finished() const;
  bool slipped() const;
  /// [s] of the whole course
  double duration() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace demo_logger
