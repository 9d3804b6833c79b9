#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <vector>

#include "demo_logger/channels/teleoperation.h"

namespace demo_logger {

/// Where the tool goes, relative to where the task started, in base axes.
struct Waypoint {
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  // [m]
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();   // [rad] rotation vector
  double duration = 3.0;                            // [s] to get there from the way-point before
};

struct SimulatedHumanConfiguration {
  TeleoperationConfiguration device;  // how axes move the arm, as the human has learned it; mode rate
  std::vector<Waypoint> task;         // empty: teleoperationTask()
  std::uint64_t seed = 1;
  double reading_period = 0.02;  // [s] of the device
  double reaction_delay = 0.2;   // [s] from the eye to the hand
  double tremor = 0.005;         // of an axis, amplitude at 9 Hz, and of the irregularity beside it
  double largest_rate = 4.0;     // [1/s] how fast the hand moves an axis
  int start_button = -1;         // pressed at the beginning and at the end, to start and stop a recording; -1: none
  int stop_button = -1;
};

/// Six way-points, back to the first pose, 17 s: shapes of a letter, with turns of the tool.
std::vector<Waypoint> teleoperationTask();

/// A human who drives the arm with a joystick, from a seed. The way-points of the task are drawn anew within a
/// centimetre, and reached in the minimum-jerk way, with the velocity in mind and the eye on the tool:
///   u = ẋ_plan(t) + k (x_plan(t − d) ⊖ x_seen(t − d)),  d the reaction delay, k = 2 1/s,
/// turned into axes by the pseudo-inverse of the device's map. Axes are within [-1, 1], of ten bits, and bounded in
/// rate; tremor rides on them. Same seed and same poses seen: same readings, bit for bit.
///
/// The course: hands off for 0.5 s (start button at 0.1 s) · enable button held, a second of rest · the task · a second
/// to settle · half a second of rest · enable let go, stop button 0.3 s later · end.
class SimulatedHuman {
 public:
  /// Throws ConfigurationError naming the field.
  explicit SimulatedHuman(SimulatedHumanConfiguration configuration);
  ~SimulatedHuman();
  SimulatedHuman(SimulatedHuman&&) noexcept;
  SimulatedHuman& operator=(SimulatedHuman&&) noexcept;

  /// The next reading of the device, one reading period after the last, seeing the tool at `X_base_tool` now. The task
  /// starts from the pose seen first.
  DeviceReading next(Nanoseconds now, const Eigen::Isometry3d& X_base_tool);

  bool finished() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace demo_logger
