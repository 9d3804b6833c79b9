#pragma once

#include <map>
#include <string>

#include "demo_logger/robot/robot_description.h"

namespace demo_logger {

// The same arm as measurements have shown it to be. Unlike a load that someone declares, what was identified may also
// be less than the description has: a URDF that carries a hand which the real arm had not.

/// The same arm with more, or less, matter at the tip: mass properties in the tip frame, as a difference to what the
/// description has. Weight and its leverage add up exactly, whatever the sign:
///   m = m₀ + Δm,   m c = m₀ c₀ + Δm Δc
/// A gain brings its own inertia with it (none: a point mass). Of a loss the extent is not known, so the last body
/// keeps its shape: I = I₀ m / m₀ about the new centre of mass, which leaves it a possible body however much is lost.
/// Throws ModelError unless m > 0, both are finite, and the new centre lies within 10 m.
RobotDescription withPayload(const RobotDescription& description, const BodyInertia& payload);

/// The same arm with other bodies, by joint, each with everything that its joint moves up to the next one. Throws
/// ModelError if a joint is not the arm's or a body is not one that could exist.
RobotDescription withBodies(const RobotDescription& description, const std::map<std::string, BodyInertia>& bodies);

}  // namespace demo_logger
