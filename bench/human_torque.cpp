// Measures how well the torque of a hand that guides the simulated arm is recovered, against the truth, from fixed
// seeds. Prints Markdown. Percent: root of the mean square error over all joints and rows, over the largest torque of
// any joint; 0.25 s are cut at both ends. Times are CPU time of the process.

#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <functional>
#include <map>
#include <random>

#include "demo_logger/pipelines/fit_model.h"
#include "demo_logger/pipelines/human_torque.h"
#include "demo_logger/pipelines/human_torque_observer.h"
#include "demo_logger/trajectory/print.h"
#include "test/pipelines/panda_run.h"
#include "test/pipelines/taught_arm.h"

namespace {

using namespace demo_logger;

constexpr double kFrictionVelocity = 0.01;  // [rad/s] of the reference integrator
constexpr std::uint64_t kSeeds = 9;         // three of each task

CalibratedArm asItIs(const RobotDescription& arm) { return calibrate(arm, ModelCalibration()); }

Teaching taught(std::uint64_t seed) {
  Teaching teaching;
  teaching.task = handTaskNames()[seed % handTaskNames().size()];
  teaching.seed = seed;
  return teaching;
}

Demonstration recovered(const TaughtRecording& recording, const CalibratedArm& arm) {
  Demonstration result = recording.log;
  addHumanTorque(arm, result);
  return result;
}

double offBy(const TaughtRecording& recording, const CalibratedArm& arm) {
  return percentOff(recording, jointColumns(recovered(recording, arm), "tau_h_"));
}

double medianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// One line of the table from a value for each seed.
void row(const std::string& what, const std::string& reach, const std::vector<double>& values, int decimals) {
  std::printf("| %s | %s | %.*f | %.*f |\n", what.c_str(), reach.c_str(), decimals, medianOf(values), decimals,
              *std::max_element(values.begin(), values.end()));
  std::fflush(stdout);
}

using Measure = std::function<double(std::uint64_t seed)>;
std::vector<double> forEachSeed(const Measure& measure) {
  std::vector<double> values;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) values.push_back(measure(seed));
  return values;
}

// ---- a model that is right

void measureExactModel() {
  const CalibratedArm arm = asItIs(taughtArm());
  row("noise-free, 1 kHz, reference integrator", "0.001 %", forEachSeed([&](std::uint64_t seed) {
        Teaching teaching = taught(seed);
        teaching.integrator = Integrator::runge_kutta_4;
        return offBy(teach(teaching), arm);
      }),
      5);
  row("noise-free, 1 kHz, default stepping (1/4 ms, semi-implicit Euler)", "0.02 %",
      forEachSeed([&](std::uint64_t seed) { return offBy(teach(taught(seed)), arm); }), 4);
  const auto withEncoder = [](std::uint64_t seed) {
    Teaching teaching = taught(seed);
    teaching.encoder_step = encoderStep(18);
    return teach(teaching);
  };
  row("encoder 2^-18 rev, 1 kHz", "0.17 %",
      forEachSeed([&](std::uint64_t seed) { return offBy(withEncoder(seed), arm); }), 3);
  row("encoder 2^-18 rev, 100 Hz", "0.24 %",
      forEachSeed([&](std::uint64_t seed) { return offBy(thinned(withEncoder(seed), 10), arm); }), 3);
  row("the same, held commands taken at half the log's interval instead of half the control period", "nine times",
      forEachSeed([&](std::uint64_t seed) {
        TaughtRecording recording = thinned(withEncoder(seed), 10);
        recording.log.metadata.effort.control_period = 0.01;
        return offBy(recording, arm);
      }),
      3);
  row("noise-free, 100 Hz", "",
      forEachSeed([&](std::uint64_t seed) { return offBy(thinned(teach(taught(seed)), 10), arm); }), 4);
  row("the same at half the log's interval", "nine times", forEachSeed([&](std::uint64_t seed) {
        TaughtRecording recording = thinned(teach(taught(seed)), 10);
        recording.log.metadata.effort.control_period = 0.01;
        return offBy(recording, arm);
      }),
      4);
  row("Gaussian noise of 1e-4 rad, 1 kHz", "0.55 %", forEachSeed([&](std::uint64_t seed) {
        Teaching teaching = taught(seed);
        teaching.position_noise = 1e-4;
        return offBy(teach(teaching), arm);
      }),
      3);
}

void measureJitter() {
  const CalibratedArm arm = asItIs(taughtArm());
  std::vector<double> ratios, ignored;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const TaughtRecording even = teach(taught(seed));
    const double step = encoderStep(18);
    TaughtRecording uneven = jittered(even, 300e-6, step, seed);
    const double without = offBy(jittered(even, 1e-12, step, seed), arm);
    ratios.push_back(offBy(uneven, arm) / without);
    uneven.log.time = even.log.time;
    ignored.push_back(offBy(uneven, arm));
  }
  row("stamps that jitter by 300 µs but are true, 2^-18, 1 kHz: times the error without jitter", "1.1", ratios, 2);
  row("the same with even stamps instead of the true ones [%]", "(3)", ignored, 2);
}

// ---- a model that has to be found first

/// The error with what was fitted; what the fit could not say stays as it was.
double offAfterFit(const TaughtRecording& recording, const RobotDescription& claimed) {
  const FitResult fit = fitModel(claimed, {&recording.log});
  if (!fit.undetermined.empty()) std::printf("<!-- not fitted: %s -->\n", fit.undetermined.c_str());
  return offBy(recording, calibrate(claimed, fit.calibration));
}

void measurePayload() {
  std::map<std::string, std::vector<double>> off;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Teaching teaching = taught(seed);
    teaching.encoder_step = encoderStep(18);
    teaching.own_motion = 12.0;
    teaching.payload = BodyInertia{0.3, {0.01, 0.02, 0.05}, Eigen::Vector3d(4e-4, 4e-4, 2e-4).asDiagonal()};
    const TaughtRecording recording = teach(teaching);
    off["0"].push_back(offBy(recording, asItIs(taughtArm())));
    off["1"].push_back(offAfterFit(recording, taughtArm()));
    off["2"].push_back(offBy(recording, asItIs(withLoad(taughtArm(), *teaching.payload))));
  }
  row("unknown payload of 0.3 kg, 2^-18, 1 kHz", "(3.7 %)", off["0"], 2);
  row("the same after the fit, hand-free parts found by itself", "0.5 %", off["1"], 3);
  row("the same, had the payload been known", "", off["2"], 3);
}

constexpr double kMoves = 0.01;  // [rad/s], from which on a joint does

/// As percentOff, of the joints only that move in a row, or that stand still.
double percentOffWhere(const TaughtRecording& recording, const Eigen::MatrixXd& torque, bool moving) {
  double squares = 0.0;
  double count = 0.0;
  for (Eigen::Index k = 0; k < torque.rows(); ++k) {
    const double t = recording.log.time[static_cast<std::size_t>(k)];
    if (t < recording.taught_from + 0.25 || t > recording.taught_to - 0.25) continue;
    for (Eigen::Index i = 0; i < 7; ++i) {
      if ((std::abs(recording.dq(k, i)) > kMoves) != moving) continue;
      squares += std::pow(torque(k, i) - recording.torque(k, i), 2);
      count += 1.0;
    }
  }
  return 100.0 * std::sqrt(squares / count) / recording.torque.cwiseAbs().maxCoeff();
}

void measureFriction() {
  RobotDescription bare = taughtArm();
  for (ArmJoint& joint : bare.joints) joint.damping = 0.0;
  for (const Integrator integrator : {Integrator::runge_kutta_4, Integrator::semi_implicit_euler}) {
    const bool is_smooth = integrator == Integrator::runge_kutta_4;
    RobotDescription known = taughtArm(/*coulomb_friction=*/true);
    if (is_smooth) {
      for (ArmJoint& joint : known.joints) joint.friction_velocity = kFrictionVelocity;
    }
    std::map<std::string, std::vector<double>> off;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      Teaching teaching = taught(seed);
      teaching.encoder_step = encoderStep(18);
      teaching.own_motion = 12.0;
      teaching.coulomb_friction = true;
      teaching.integrator = integrator;
      const TaughtRecording recording = teach(teaching);
      const FitResult fit = fitModel(bare, {&recording.log});
      if (!fit.undetermined.empty()) std::printf("<!-- not fitted: %s -->\n", fit.undetermined.c_str());
      const CalibratedArm fitted = calibrate(bare, fit.calibration);
      const Eigen::MatrixXd torque = jointColumns(recovered(recording, fitted), "tau_h_");
      off["0"].push_back(offBy(recording, asItIs(bare)));
      off["1"].push_back(percentOff(recording, torque));
      off["2"].push_back(offBy(recording, asItIs(known)));
      off["3"].push_back(percentOffWhere(recording, torque, /*moving=*/true));
      off["4"].push_back(percentOffWhere(recording, torque, /*moving=*/false));
    }
    row(is_smooth ? "unknown friction F tanh(q̇ / 0.01 rad/s) and viscous, 2^-18, 1 kHz"
                  : "unknown friction that holds (stiction) and viscous, 2^-18, 1 kHz",
        "(5 %)", off["0"], 2);
    row("the same after the fit", is_smooth ? "0.7 %" : "", off["1"], 3);
    row("the same, had it been known", "", off["2"], 3);
    if (is_smooth) continue;
    row("the same after the fit, joints that move", "0.7 %", off["3"], 3);
    row("the same after the fit, joints that stand still", "", off["4"], 3);
  }
}

// ---- as it happens

struct Online {
  double raw;
  double shifted;  // the delay removed
};

Online observe(const TaughtRecording& recording) {
  HumanTorqueObserverConfiguration configuration;
  configuration.effort = recording.log.metadata.effort;
  HumanTorqueObserver observer(asItIs(taughtArm()), configuration);
  const Eigen::Index rows = recording.q.rows();
  Eigen::MatrixXd raw(rows, 7);
  Eigen::VectorXd torque(7);
  for (Eigen::Index k = 0; k < rows; ++k) {
    observer.update(k * kMillisecond, recording.log.values.row(k).head(7), recording.log.values.row(k).tail(7), torque);
    raw.row(k) = torque;
  }
  const auto late = static_cast<Eigen::Index>(std::lround(1e3 * observer.delay()));
  Eigen::MatrixXd shifted = Eigen::MatrixXd::Constant(rows, 7, std::nan(""));
  shifted.topRows(rows - late) = raw.bottomRows(rows - late);
  return {percentOff(recording, raw), percentOff(recording, shifted)};
}

void measureOnline() {
  std::vector<double> raw, shifted;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Teaching teaching = taught(seed);
    teaching.encoder_step = encoderStep(18);
    const Online online = observe(teach(teaching));
    raw.push_back(online.raw);
    shifted.push_back(online.shifted);
  }
  row("online observer, 2^-18, 1 kHz, defaults: as it comes", "3 %", raw, 2);
  row("the same, its delay removed", "0.8 %", shifted, 2);
}

// ---- honesty, cost

void measureHonesty() {
  const CalibratedArm arm = asItIs(taughtArm());
  std::printf(
      "\n## Is it as sure as it says\n\nShare of samples whose error is within two of their own standard "
      "deviations, and the root mean square of error over deviation; exact model, 1 kHz, all joints and rows.\n\n"
      "| noise | within 2σ (median, least) | rms(error / σ) (median, largest) |\n|---|---|---|\n");
  for (const double noise : {1e-5, 1e-4, 1e-3, 3e-3, 0.0}) {
    std::vector<double> within, ratio;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      Teaching teaching = taught(seed);
      teaching.position_noise = noise;
      if (noise == 0.0) teaching.encoder_step = encoderStep(18);
      const TaughtRecording recording = teach(teaching);
      const Demonstration result = recovered(recording, arm);
      const Eigen::MatrixXd error = jointColumns(result, "tau_h_") - recording.torque;
      const Eigen::ArrayXXd relative = error.array() / jointColumns(result, "tau_h_std_").array();
      within.push_back((relative.abs() <= 2.0).cast<double>().mean());
      ratio.push_back(std::sqrt(relative.square().mean()));
    }
    std::printf("| %s | %.1f %%, %.1f %% | %.2f, %.2f |\n",
                noise > 0.0 ? ("Gaussian " + std::to_string(noise).substr(0, 7) + " rad").c_str() : "encoder 2^-18 rev",
                100.0 * medianOf(within), 100.0 * *std::min_element(within.begin(), within.end()), medianOf(ratio),
                *std::max_element(ratio.begin(), ratio.end()));
  }
  std::printf(
      "\nThe hand trembles at 7 to 11 Hz, the wrists by some 2e-4 rad. Under noise of 1e-3 rad the smoother takes most "
      "of that away; the deviation holds it as far as the residuals show it beyond chance. Under 3e-3 rad they hardly "
      "show it in a recording of 8 s, and what noise hides no deviation can hold.\n");
}

void measureHonestyOfFriction() {
  std::printf(
      "\nWith stiction that the model has, encoder 2^-18 rev, 1 kHz: share within two standard deviations (median, "
      "least).\n\n| joints that move | joints that stand still |\n|---|---|\n");
  const CalibratedArm known = asItIs(taughtArm(/*coulomb_friction=*/true));
  std::vector<double> moving, standing;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Teaching teaching = taught(seed);
    teaching.encoder_step = encoderStep(18);
    teaching.coulomb_friction = true;
    const TaughtRecording recording = teach(teaching);
    const Demonstration result = recovered(recording, known);
    const Eigen::ArrayXXd error = (jointColumns(result, "tau_h_") - recording.torque).array().abs();
    const Eigen::ArrayXXd within = (error <= 2.0 * jointColumns(result, "tau_h_std_").array()).cast<double>();
    const Eigen::ArrayXXd moves = (recording.dq.array().abs() > kMoves).cast<double>();
    moving.push_back((within * moves).sum() / moves.sum());
    standing.push_back((within * (1.0 - moves)).sum() / (1.0 - moves).sum());
  }
  std::printf("| %.1f %%, %.1f %% | %.1f %%, %.1f %% |\n", 100.0 * medianOf(moving),
              100.0 * *std::min_element(moving.begin(), moving.end()), 100.0 * medianOf(standing),
              100.0 * *std::min_element(standing.begin(), standing.end()));
}

/// A guided arm for as long as one likes: one teaching after the other.
Demonstration repeated(const Demonstration& log, Eigen::Index rows, double jitter) {
  Demonstration longer = log;
  longer.time.clear();
  longer.values.resize(rows, log.values.cols());
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, jitter);
  for (Eigen::Index k = 0; k < rows; ++k) {
    longer.time.push_back(1e-3 * static_cast<double>(k) + std::clamp(normal(random), -4e-4, 4e-4));
    longer.values.row(k) = log.values.row(k % log.values.rows());
  }
  return longer;
}

void measureCost() {
  std::printf(
      "\n## Cost\n\nOf `addHumanTorque`, 7 joints at 1 kHz, one core; memory is what the process holds at most "
      "beyond the log itself.\n\n| recording | efforts | stamps | CPU time | per row | memory "
      "|\n|---|---|---|---|---|---|\n");
  Teaching teaching = taught(1);
  teaching.encoder_step = encoderStep(18);
  const TaughtRecording recording = teach(teaching);
  const CalibratedArm arm = asItIs(taughtArm());
  const CalibratedArm with_friction = asItIs(taughtArm(/*coulomb_friction=*/true));
  teaching.coulomb_friction = true;
  const TaughtRecording held_by_friction = teach(teaching);
  for (const Eigen::Index seconds : {15, 30, 60, 120}) {
    for (const char* const timing : {"held", "instant", "held, stiction known"}) {
      for (const double jitter : {0.0, 5e-5}) {
        const bool has_friction = std::strlen(timing) > 8;
        Demonstration log = repeated((has_friction ? held_by_friction : recording).log, 1000 * seconds, jitter);
        log.metadata.effort.timing = has_friction ? "held" : timing;
        rusage before{};
        getrusage(RUSAGE_SELF, &before);
        const std::clock_t start = std::clock();
        addHumanTorque(has_friction ? with_friction : arm, log);
        const double spent = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
        rusage after{};
        getrusage(RUSAGE_SELF, &after);
        const long grown = (after.ru_maxrss - before.ru_maxrss) / 1024;
        std::printf("| %ld s | %s | %s | %.2f s | %.1f µs | %s |\n", static_cast<long>(seconds), timing,
                    jitter > 0.0 ? "uneven" : "even", spent, 1e3 * spent / static_cast<double>(seconds),
                    grown > 0 ? ("+ " + std::to_string(grown) + " MiB").c_str() : "");
        std::fflush(stdout);
      }
    }
  }
}

// ---- a real arm

void measurePanda() {
  const auto arm = describePanda();
  const auto run = readPandaRun();
  std::printf("\n## A real arm without a hand\n\n");
  if (!arm || !run) {
    std::printf("Not measured: DEMO_LOGGER_DATA and DEMO_LOGGER_URDF name no folders with a Panda's run and URDF.\n");
    return;
  }
  std::printf(
      "A Franka Panda's identification run of 21 s without contact. Models are fitted to its first 14 s; what they "
      "leave of the last 7 s, joint by joint, as root mean square [N m]: at every row, and through quartics that "
      "are fitted to 0.3 s around it, as the published model was looked at.\n\n"
      "| model | looked at | 1 | 2 | 3 | 4 | 5 | 6 | 7 |\n|---|---|---|---|---|---|---|---|---|\n");
  struct Model {
    const char* name;
    bool fitted, friction, bodies;
  };
  for (const Model& model : {Model{"URDF as it is (with a hand that this arm had not)", false, false, false},
                             Model{"+ payload and torque bias", true, false, false},
                             Model{"+ friction (`--fit-friction`)", true, true, false},
                             Model{"+ all bodies (`--fit-friction --fit-bodies`)", true, true, true}}) {
    CalibratedArm calibrated = asItIs(*arm);
    if (model.fitted) {
      FitOptions options;
      options.hand_free = {{0.0, 14.0}};
      options.friction = model.friction;
      options.bodies = model.bodies;
      calibrated = calibrate(*arm, fitModel(*arm, {&*run}, options).calibration);
    }
    Demonstration result = *run;
    addHumanTorque(calibrated, result);
    std::string rows, quartics;
    for (Eigen::Index i = 0; i < 7; ++i) {
      const Eigen::VectorXd left = result.values.col(14 + 14 + i);  // after positions, efforts, dq, ddq
      std::vector<double> late;
      for (std::size_t k = 0; k < result.time.size(); ++k) {
        if (result.time[k] >= 14.0) late.push_back(left[static_cast<Eigen::Index>(k)]);
      }
      rows += " " + print(rootMeanSquare(late), 2) + " |";
      quartics += " " + print(rootMeanSquare(throughQuartics(result.time, left, 14.0, 21.0)), 2) + " |";
    }
    std::printf("| %s | rows |%s\n| | quartics |%s\n", model.name, rows.c_str(), quartics.c_str());
  }
  std::printf("| published model with its friction (whole run) | quartics |");
  for (const double residual : kPublishedResidual) std::printf(" %.2f |", residual);
  std::printf("\n");
}

}  // namespace

int main() {
  std::printf(
      "A simulated hand guides the demo arm (viscous friction of 0.12 to 1 N m s/rad, which the model has) under "
      "gravity compensation at 1 kHz,\n%d times from fixed seeds through the tasks reach, arc and peg. "
      "`reach`: what was to be reached; in brackets, what ignoring it costs.\n\n"
      "| case | reach | median | worst |\n|---|---|---|---|\n",
      static_cast<int>(kSeeds));
  measureExactModel();
  measureJitter();
  measurePayload();
  measureFriction();
  measureOnline();
  measureHonesty();
  measureHonestyOfFriction();
  measurePanda();
  measureCost();
  return 0;
}
