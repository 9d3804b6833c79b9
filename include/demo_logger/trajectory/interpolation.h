#pragma once

#include <Eigen/Core>

#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

/// Where `instant` lies between two others: 0 at `before`, 1 at `after`; 0 if the two coincide. The differences are
/// taken in integers, so instants since the epoch keep their nanoseconds.
double fractionBetween(Nanoseconds before, Nanoseconds instant, Nanoseconds after);

/// The straight line from `from` (fraction 0) to `to` (fraction 1), exact at both ends.
double interpolateLinearly(double from, double to, double fraction);

/// Rotates from one orientation to another about a fixed axis at constant speed, along the shorter of the two arcs:
///   slerp = from sin((1 − f) θ)/sin θ + to sin(f θ)/sin θ       (θ: angle between the two in R⁴; f: fraction)
/// Quaternions are x y z w; q and −q are the same orientation. Inputs need not be normalised, the result is. NaN where
/// an input is zero or not finite. Orientations half a turn apart have two shortest arcs; the one without a change of
/// sign is taken.
Eigen::Vector4d interpolateSpherically(const Eigen::Vector4d& from, const Eigen::Vector4d& to, double fraction);

}  // namespace demo_logger
