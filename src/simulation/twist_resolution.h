#pragma once

#include <Eigen/Core>

namespace demo_logger {

/// Joint velocities for a twist of the tip, by least squares; of least norm where there are many.
struct ResolvedTwist {
  Eigen::VectorXd velocity;
  bool damped = false;  // the arm is near a singularity, and the tip falls short of the twist
};

/// v = J⁺ V, where a singular value σ below ε is inverted to σ/ε² instead of 1/σ (damped least squares, σ/(σ² + λ²)
/// with λ² = ε² − σ²). The joints then stay slow instead of racing, at the price of the twist's part along that
/// direction.
ResolvedTwist resolveTwist(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& twist);

}  // namespace demo_logger
