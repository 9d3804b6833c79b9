#include "src/tool/torque_fit.h"
#include "src/tool/output_plan.h"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/print.h"
#include "src/tool/number_option.h"
#include "src/tool/verbs.h"

namespace demo_logger {
namespace {

using nlohmann::ordered_json;

/// "FROM:TO"
TimeSpan toSpan(const std::string& text) {
  const auto refuse = [&] {
    return ConfigurationError("--hand-free is \"" + text +
                              "\", expected FROM:TO in seconds since the first row, FROM before TO");
  };
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) throw refuse();
  TimeSpan span;
  if (!CLI::detail::lexical_cast(text.substr(0, colon), span.from) ||
      !CLI::detail::lexical_cast(text.substr(colon + 1), span.to) || !std::isfinite(span.from) ||
      !std::isfinite(span.to) || span.from >= span.to) {
    throw refuse();
  }
  return span;
}

std::string partsOf(const FitResult& result, std::size_t recordings) {
  constexpr std::size_t kMost = 8;
  std::string list;
  for (std::size_t i = 0; i < std::min(kMost, result.hand_free.size()); ++i) {
    const FitResult::Part& part = result.hand_free[i];
    list += (i == 0 ? "" : ", ") + print(part.span.from, 2) + " to " + print(part.span.to, 2) + " s";
    if (recordings > 1) list += " of recording " + std::to_string(part.recording + 1);
  }
  if (result.hand_free.size() > kMost) list += " and " + std::to_string(result.hand_free.size() - kMost) + " more";
  return list;
}

}  // namespace

void addTorqueFitOptions(CLI::App& verb, TorqueFitOptions& options) {
  verb.add_option("--model", options.model,
                  "what the arm has beyond its URDF: payload, torque bias, friction (YAML); with --fit, where that "
                  "starts: values with a deviation are held so firmly, those without stay");
  verb.add_option("--fit", options.fit,
                  "find out payload, torque bias and friction where no hand touches the arm, write them to this file "
                  "(YAML) and go by them");
  verb.add_option("--hand-free", options.hand_free,
                  "FROM:TO [s] since the first row, where no hand touches the arm; may be repeated (default: found, as "
                  "what one model explains)")
      ->needs("--fit");
  verb.add_flag_function(
          "--fit-friction,!--no-fit-friction", [&options](std::int64_t count) { options.friction = count > 0; },
          "fit friction (default: if the efforts are those of the motors)")
      ->needs("--fit");
  verb.add_flag("--fit-bodies", options.bodies,
                "fit mass, centre and inertia of every body, not those of a payload alone; takes a long motion of all "
                "joints, far and fast")
      ->needs("--fit");
  CLI::Option* const model_error =
      verb.add_option("--model-error", options.model_error,
                      "how far the fitted model may be off where no hand is, in parts of what a joint usually bears");
  requireNumber(*model_error->capture_default_str()->needs("--fit"), {"", 1e-4, 1.0});
}

std::string stepOf(const TorqueFitOptions& options) {
  const auto nameOf = [](const std::string& path) { return std::filesystem::path(path).filename().string(); };
  std::string step;
  if (!options.model.empty()) step += " --model " + nameOf(options.model);
  if (options.fit.empty()) return step;
  step += " --fit " + nameOf(options.fit);
  for (const std::string& span : options.hand_free) step += " --hand-free " + span;
  if (options.friction) step += *options.friction ? " --fit-friction" : " --no-fit-friction";
  if (options.bodies) step += " --fit-bodies";
  return step + " --model-error " + print(options.model_error);
}

TorqueModel::TorqueModel(TorqueFitOptions options, bool force, bool json)
    : options_(std::move(options)), force_(force), json_(json) {
  for (const std::string& span : options_.hand_free) hand_free_.push_back(toSpan(span));
}

std::optional<int> TorqueModel::prepare(const RobotDescription& arm, const std::vector<LoadedDemonstration>& recordings,
                                        FitOptions fit) {
  arm_ = calibrate(arm, std::filesystem::path(options_.model));
  if (options_.fit.empty()) return std::nullopt;

  if (!force_) refuseToOverwrite(options_.fit);
  if (!options_.hand_free.empty() && recordings.size() > 1) {
    throw ConfigurationError("--hand-free says when in one recording, but there are " +
                             std::to_string(recordings.size()) + "; fit to one of them");
  }
  if (!options_.model.empty()) fit.start = readModelCalibration(options_.model);
  fit.hand_free = hand_free_;
  fit.friction = options_.friction;
  fit.bodies = options_.bodies;
  fit.model_error = options_.model_error;
  std::vector<const Demonstration*> demonstrations;
  demonstrations.reserve(recordings.size());
  for (const LoadedDemonstration& recording : recordings) demonstrations.push_back(&recording.demonstration);
  recordings_ = recordings.size();
  result_ = fitModel(arm, demonstrations, fit);
  if (!result_->undetermined.empty()) {
    if (json_) {
      std::cout << ordered_json{{"fit", {{"model", nullptr}, {"reason", result_->undetermined}}}}.dump(2) << '\n';
    } else {
      std::cerr << options_.fit << ": not fitted, nothing written: " << result_->undetermined << '\n';
    }
    return kFindings;
  }
  arm_ = calibrate(arm, result_->calibration);
  return std::nullopt;
}

void TorqueModel::write(AtomicFiles& files) const {
  if (result_) files.add(options_.fit, force_).write(textOf(result_->calibration));
}

bool TorqueModel::conclude(ordered_json& report) const {
  if (!result_) return false;
  ordered_json parts = ordered_json::array();
  for (const FitResult::Part& part : result_->hand_free) {
    parts.push_back({{"recording", part.recording}, {"from", part.span.from}, {"to", part.span.to}});
  }
  report["fit"] = {{"model", options_.fit},
                   {"duration", result_->duration},
                   {"rows", result_->rows},
                   {"hand_free", parts},
                   {"residual_start", result_->residual_start},
                   {"residual", result_->residual},
                   {"findings", result_->findings},
                   {"doubts", result_->doubts}};
  if (!json_) say(*result_, recordings_);
  return !result_->doubts.empty();
}

void TorqueModel::say(const FitResult& result, std::size_t recordings) const {
  std::cout << options_.fit << ": fitted to " << result.rows << " rows in " << print(result.duration, 1)
            << " s without a hand: " << partsOf(result, recordings) << '\n';
  for (const std::string& finding : result.findings) std::cout << "  " << finding << '\n';
  std::cout << "  what is left there, from joint to joint (root mean square; before the fit):";
  for (std::size_t i = 0; i < result.residual.size(); ++i) {
    std::cout << (i == 0 ? " " : ", ");
    if (std::isnan(result.residual[i])) {
      std::cout << "nothing told";
    } else {
      std::cout << print(result.residual[i], 3) << " (" << print(result.residual_start[i], 3) << ")";
    }
  }
  std::cout << " N m or N\n";
  for (const std::string& doubt : result.doubts) std::cout << "  " << doubt << '\n';
}

}  // namespace demo_logger
