#pragma once

#include <Eigen/Core>
#include <vector>

#include "demo_logger/trajectory/motion_smoother.h"

namespace demo_logger {

/// A random snap is one kind of motion; a tremor too weak to be followed is another, and so is a jolt. What of them the
/// smoothing removed is in the residuals z − q̂, beside the noise. At the angular frequency ω, H = 1 / (1 + (ωT)⁸) of a
/// motion is kept, and the model expects residuals of the power (1 − H) r. Where there is more, by more than chance,
/// that excess p(ω) is motion that the estimate lacks: its error in the i-th derivative has the power ω²ⁱ p(ω), which
/// is added to the covariance. It is looked for from 0.8/T (slower motion is kept) to 4/T, in segments of 24 T, each by
/// itself and together with up to 8 to either side: what lasts is found though it be weak. The steps of an encoder that
/// no other noise blurs look like motion themselves; then nothing is added. Takes time linear in the samples.
///
/// `interval`: the usual one between samples [s]. `liveliness`: as the filter had it.
void addRemovedMotion(const std::vector<double>& time, const Eigen::VectorXd& position, double interval,
                      const std::vector<double>& liveliness, SmoothedMotion& motion);

}  // namespace demo_logger
