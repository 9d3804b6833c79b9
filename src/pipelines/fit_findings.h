#pragma once

#include "fit_decisions.h"
#include "fit_problem.h"
#include "ridge_regression.h"

namespace demo_logger {

/// What an estimate means: fills the calibration, and a sentence for each quantity, also for those that the motions do
/// not tell, which stay as the start has them.
void describeFit(const FitProblem& problem, const RidgeEstimate& estimate, const FitDecisions& decisions,
                 const FitOptions& options, const EffortMetadata& meaning, FitResult& result);

}  // namespace demo_logger
