#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "demo_logger/formats/atomic_file.h"
#include "demo_logger/formats/demonstration_file.h"
#include "demo_logger/pipelines/fit_model.h"
#include "demo_logger/pipelines/model_calibration.h"

namespace demo_logger {

/// What `torque` takes of a model: one to go by, and one to be found out.
struct TorqueFitOptions {
  std::string model;                   // --model
  std::string fit;                     // --fit
  std::vector<std::string> hand_free;  // --hand-free FROM:TO
  std::optional<bool> friction;
  bool bodies = false;
  double model_error = FitOptions().model_error;
};

void addTorqueFitOptions(CLI::App& verb, TorqueFitOptions& options);

/// As it stands in the provenance: " --model a.yaml --fit b.yaml".
std::string stepOf(const TorqueFitOptions& options);

/// The model that the torques of one call go by.
class TorqueModel {
 public:
  /// Throws ConfigurationError for a --hand-free that is not FROM:TO.
  TorqueModel(TorqueFitOptions options, bool force, bool json);

  /// Reads --model, and fits. `fit` has what else decides. Returns an exit code if the fit is not determined, having
  /// said why.
  std::optional<int> prepare(const RobotDescription& arm, const std::vector<LoadedDemonstration>& recordings,
                             FitOptions fit);
  const CalibratedArm& arm() const { return *arm_; }
  /// Adds the file of what was fitted, if anything was. Throws FileError.
  void write(AtomicFiles& files) const;
  /// Says what was fitted. Returns whether that is in doubt.
  bool conclude(nlohmann::ordered_json& report) const;

 private:
  void say(const FitResult& result, std::size_t recordings) const;

  const TorqueFitOptions options_;
  const bool force_;
  const bool json_;
  std::vector<TimeSpan> hand_free_;
  std::optional<CalibratedArm> arm_;
  std::optional<FitResult> result_;
  std::size_t recordings_ = 0;
};

}  // namespace demo_logger
