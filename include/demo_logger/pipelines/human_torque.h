#pragma once

#include <optional>
#include <string>
#include <vector>

#include "demo_logger/pipelines/model_calibration.h"
#include "demo_logger/robot/robot_description.h"
#include "demo_logger/trajectory/demonstration.h"

namespace demo_logger {

struct HumanTorqueOptions {
  std::optional<EffortMetadata> effort;  // what the efforts mean; nothing: what the recording's metadata says
  /// The arm was compensated for gravity while it was taught: τ_motor or τ_link = g(q), by the side that is said of
  /// them, stands in for efforts that are not there.
  bool gravity_compensated = false;
  double max_gap = 0.1;  // [s] nothing is concluded across a longer silence of the joints
};

struct HumanTorqueSummary {
  std::size_t rows = 0;                // with a torque for every joint
  std::vector<double> encoder_noise;   // per joint, standard deviation of a measured position [rad or m]
  std::vector<double> largest_torque;  // per joint [N m or N]; NaN: none known
  std::vector<std::string> notes;      // what had to be assumed or left out, in sentences
};

/// Recovers the torque that a person exerted on the joints while teaching (design of the equation of motion as in
/// RobotModel):
///   τ_h = M(q) q̈ + C(q, q̇) q̇ + g(q) + B q̈ + D q̇ + F sign(q̇) − τ_motor       efforts of the motors
///   τ_h = M(q) q̈ + C(q, q̇) q̇ + g(q) − τ_link                                 efforts measured at the links
/// q, q̇, q̈ come from smoothMotion at the true stamps. An effort that was held (a command from its tick to the next)
/// acts half a control period h late: it is taken at t − h/2. One that was measured at an instant is smoothed as the
/// positions are. Drives and loads of `robot` count; it may be given others by withDrives and withLoad.
///
/// Where friction counts, so does that it holds. As a joint comes to a stand or turns round, its friction changes at
/// once, and so do the accelerations of all joints that move: they are smoothed as such, with jumps there. A joint that
/// stands hides anything from −F to F of torque: 0 is taken for that, with the deviation F/√3.
///
/// Adds, or replaces: `tau_h_<joint>`, `tau_h_std_<joint>` (standard deviation of each, which tells the noise of
/// encoders and torque sensors and what friction hides, not an error of the model), `dq_<joint>` and `ddq_<joint>`
/// (smoothed), and at the tool, in base axes, the force that explains the torques best, F = (Jᵀ)⁺ τ_h: `tool_fx …
/// tool_tz`, with `tool_condition`, the ratio of the largest singular value of J to the smallest (metres beside
/// radians): large near a singular posture, where F says little. NaN where nothing can be said: within silences longer
/// than max_gap, where fewer than kFewestSamples rows are left between them, or where an effort is missing.
///
/// Throws ConfigurationError naming the first joint without a column of positions, efforts that no joint has
/// (unless gravity_compensated), an unknown side or timing, or held efforts without their control period; ModelError
/// for an arm without inertia.
/// With a calibrated arm, its torque bias is taken off the efforts, and its drives count, if it was made with efforts
/// of the same side (CalibratedArm); a note says if not.
HumanTorqueSummary addHumanTorque(const CalibratedArm& arm, Demonstration& demonstration,
                                  const HumanTorqueOptions& options = {});
HumanTorqueSummary addHumanTorque(const RobotDescription& robot, Demonstration& demonstration,
                                  const HumanTorqueOptions& options = {});

}  // namespace demo_logger
