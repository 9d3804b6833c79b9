#pragma once

#include <Eigen/Core>

namespace demo_logger {

/// How a compliant arm resists the hand that teaches it, per joint.
struct ImpedanceGains {
  Eigen::VectorXd stiffness;  // K_p [N m/rad or N/m]; zero: the arm stays where it is put
  Eigen::VectorXd damping;    // K_d [N m s/rad or N s/m]
};

/// What an arm's controller gives its motors while a hand guides it, from one tick to the next.
///   gravity compensation:  τ_c = g(q)                                K_p = K_d = 0
///   joint impedance:       τ_c = g(q) − K_p (q − q_ref) − K_d q̇
/// so that the hand feels M q̈ + C q̇ + K_p (q − q_ref) + K_d q̇ = τ_h. Each torque is cut off at ± `limit`.
/// A pure function of its arguments: gravity is the caller's, of the arm as it stands. NaN in, NaN out.
Eigen::VectorXd impedanceTorque(const ImpedanceGains& gains, const Eigen::VectorXd& gravity, const Eigen::VectorXd& q,
                                const Eigen::VectorXd& dq, const Eigen::VectorXd& q_ref, const Eigen::VectorXd& limit);

/// Whether such a controller, which holds its torque for a period h, keeps the arm stable where its mass matrix is M.
struct ImpedanceStability {
  double damping_rate = 0.0;     // λmax(M⁻¹ K_d) [1/s]; beyond 1/h a moving joint is thrown back within one period
  double spectral_radius = 0.0;  // of one period of the loop about q_ref; beyond 1 it grows
  bool stable = false;           // both within their bounds
};

/// With δ = q − q_ref and M constant over a period, one period of the loop is exactly
///   δ' = δ + h δ̇ + h²/2 a,   δ̇' = δ̇ + h a,   a = −M⁻¹ (K_p δ + K_d δ̇)
/// A bound joint by joint is not enough: M⁻¹ couples them, and a light joint behind a heavy one is the first to go.
ImpedanceStability judgeStability(const ImpedanceGains& gains, const Eigen::MatrixXd& M, double h);

}  // namespace demo_logger
