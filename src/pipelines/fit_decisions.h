#pragma once

#include <vector>

#include "demo_logger/pipelines/model_calibration.h"
#include "fit_problem.h"
#include "ridge_regression.h"

namespace demo_logger {

/// What is made of an estimate. Whatever is not taken as it was estimated is told to the problem, so that all the rest
/// is fitted anew to what will be written.
struct FitDecisions {
  enum class Payload {
    undecided,
    stated,      // known beforehand
    untold,      // nothing known of it, stays as it was
    none,        // nothing to be seen
    at_tip,      // as estimated
    last_body,   // rather another mass and centre of the last body
    impossible,  // what would explain the torques cannot be; stays as it was
    in_bodies    // bodies are free, which have it
  };
  Payload payload = Payload::undecided;
  CalibratedValue seen_mass;      // where there is none, or it cannot be
  bool mass_is_replaced = false;  // by one with which the payload is where a payload can be
  std::vector<bool> left;         // by parameter of the drives: not told, stays as it was
};

/// Whether the data tell a parameter at all.
bool isTold(const FitProblem& problem, const RidgeEstimate& estimate, Eigen::Index at);

/// Takes one decision more. Returns whether that changed the problem, which then has to be fitted again.
bool decide(FitProblem& problem, const RidgeEstimate& estimate, FitDecisions& decisions);

}  // namespace demo_logger
