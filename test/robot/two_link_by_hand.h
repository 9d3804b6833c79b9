#pragma once

#include <Eigen/Core>
#include <cmath>

namespace demo_logger {

/// The closed form of urdf/two_link.urdf, written down from the textbook: a rod and a massless rod with a point mass
/// at its end, both turning about +y, straight up at 0.
struct TwoLinkByHand {
  static constexpr double m1 = 2.0, m2 = 1.0;        // [kg]
  static constexpr double l1 = 0.5, l2 = 0.4;        // [m]
  static constexpr double c1 = l1 / 2.0;             // [m] centre of the rod
  static constexpr double I1 = m1 * l1 * l1 / 12.0;  // [kg m²] about its centre
  static constexpr double g = 9.81;                  // [m/s²]

  static Eigen::Vector3d tip(const Eigen::Vector2d& q) {
    return {l1 * std::sin(q[0]) + l2 * std::sin(q[0] + q[1]), 0.0, l1 * std::cos(q[0]) + l2 * std::cos(q[0] + q[1])};
  }

  static Eigen::Matrix2d mass(const Eigen::Vector2d& q) {
    const double coupling = m2 * l1 * l2 * std::cos(q[1]);
    Eigen::Matrix2d M;
    M << I1 + m1 * c1 * c1 + m2 * (l1 * l1 + l2 * l2) + 2.0 * coupling, m2 * l2 * l2 + coupling,  //
        m2 * l2 * l2 + coupling, m2 * l2 * l2;
    return M;
  }

  static Eigen::Vector2d coriolis(const Eigen::Vector2d& q, const Eigen::Vector2d& dq) {
    const double h = m2 * l1 * l2 * std::sin(q[1]);
    return {-h * (2.0 * dq[0] * dq[1] + dq[1] * dq[1]), h * dq[0] * dq[0]};
  }

  static Eigen::Vector2d gravity(const Eigen::Vector2d& q) {
    const double outer = -m2 * l2 * g * std::sin(q[0] + q[1]);
    return {-(m1 * c1 + m2 * l1) * g * std::sin(q[0]) + outer, outer};
  }

  static double energy(const Eigen::Vector2d& q, const Eigen::Vector2d& dq) {
    const double potential = g * (m1 * c1 * std::cos(q[0]) + m2 * tip(q).z());
    return potential + 0.5 * dq.dot(mass(q) * dq);
  }
};

}  // namespace demo_logger
