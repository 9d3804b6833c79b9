#pragma once

#include <Eigen/Core>
#include <vector>

#include "demo_logger/channels/impedance.h"
#include "demo_logger/robot/robot_description.h"

namespace demo_logger {

/// Postures of the workspace at which gains are judged: so many, spread evenly over the joints' limits by a
/// low-discrepancy sequence, the same each time. A sample, not a proof: between them λmax may be somewhat larger, which
/// the bound of 1/h covers, as the held loop itself only breaks at 2/h.
constexpr int kJudgedPostures = 512;
std::vector<Eigen::VectorXd> judgedPostures(const RobotDescription& arm);

/// The largest stiffness [N m/rad or N/m] and damping [N m s/rad or N s/m] that are considered: far beyond any arm, far
/// within what can be reckoned with.
constexpr double kLargestGain = 1e9;

/// The gains of one who asks for `stiffness` and `damping`: each one value per joint, one for all of them, or none,
/// which means that of `defaults`. Throws ConfigurationError naming the joint, the value with its unit and what was
/// expected.
ImpedanceGains impedanceGains(const RobotDescription& arm, const std::vector<double>& stiffness,
                              const std::vector<double>& damping, const ImpedanceGains& defaults);

/// Gains for an arm of which nothing but its masses is known: 4 rad/s with the mean inertia that the heaviest joint
/// feels, √(M_ii / M_max) as stiff at the others, as light joints need more than their share against their friction;
/// damping 0.7 of the critical, less if the held loop asks for it. Always stable (requireStable).
ImpedanceGains defaultImpedanceGains(const RobotDescription& arm, double control_period);

/// Refuses gains that are not from 0 to kLargestGain, and those with which a torque held for h = `control_period` [s]
/// makes the arm unstable (judgeStability) at any of judgedPostures() or at `also`, where it stands, if that is not
/// empty. M counts the motors' inertia, not the arm's own friction, which may only help. Throws ConfigurationError with
/// the joint, the value, the bound and what to try: too much damping beyond λmax(M⁻¹ K_d) ≤ 1/h, or too little for the
/// stiffness. K_d ≥ h K_p / 2 joint by joint is always enough: a spring held for h pushes h/2 late, as much as a damper
/// of −h K_p / 2.
void requireStable(const ImpedanceGains& gains, const RobotDescription& arm, double control_period,
                   const Eigen::VectorXd& also = {});

}  // namespace demo_logger
