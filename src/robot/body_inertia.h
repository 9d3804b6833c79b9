#pragma once

#include <string>

#include "demo_logger/robot/robot_description.h"

namespace demo_logger {

/// The same matter seen from frame A: `body` is given in frame B.
BodyInertia movedTo(const Eigen::Isometry3d& X_A_B, const BodyInertia& body);

/// Two rigid bodies as one, both in the same frame.
BodyInertia lumped(const BodyInertia& a, const BodyInertia& b);

/// Empty if one can compute with these mass properties, else what is impossible, as the end of a sentence ("has …").
/// Possible: finite, mass above 0 (or no matter at all), principal moments I₁ ≤ I₂ ≤ I₃ with 0 ≤ I₁ and I₃ ≤ I₁ + I₂.
/// A point mass (all zero) and a thin rod (I₃ = I₂) are possible. Arms that people own miss I₁ + I₂ by a few per cent,
/// as identified and simplified models do: up to a fifth of I₃ is let pass here.
std::string impossibility(const BodyInertia& body);

/// As above without that indulgence: also what is only doubtful.
std::string implausibility(const BodyInertia& body);

}  // namespace demo_logger
