#include "demo_logger/simulation/simulated_human.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "demo_logger/simulation/gaussian_noise.h"
#include "demo_logger/trajectory/error.h"
#include "print.h"
#include "waypoint_path.h"

namespace demo_logger {
namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr double kVisualGain = 2.0;       // [1/s] k
constexpr double kTremorFrequency = 9.0;  // [Hz] physiological tremor lies between 8 and 12
constexpr double kAxisSteps = 512.0;      // from 0 to 1
// The course of a task [s].
constexpr double kStartPressed = 0.1;
constexpr double kPress = 0.2;
constexpr double kEnabled = 0.5;
constexpr double kRestBefore = 1.0;
constexpr double kSettle = 1.0;
constexpr double kRestAfter = 0.5;
constexpr double kStopAfterRelease = 0.3;
constexpr double kEnd = 0.5;  // after the stop button was pressed

using Twist = Eigen::Matrix<double, 6, 1>;

void require(bool holds, const std::string& field, double value, const std::string& expected) {
  if (holds && std::isfinite(value)) return;
  throw ConfigurationError("simulated human: " + field + " is " + print(value) + ", expected " + expected + ".");
}

void validate(const SimulatedHumanConfiguration& human) {
  if (human.device.map.mode != TeleopMode::rate) {
    throw ConfigurationError(
        "simulated human: the device's mode is pose, expected rate, which this human has learned.");
  }
  require(human.reading_period >= 0.001 && human.reading_period <= 0.1, "reading_period", human.reading_period,
          "from 0.001 to 0.1 s");
  require(human.reaction_delay >= 0.0 && human.reaction_delay <= 0.5, "reaction_delay", human.reaction_delay,
          "from 0 to 0.5 s; a slower eye makes the hand oscillate");
  require(human.tremor >= 0.0 && human.tremor <= 0.2, "tremor", human.tremor, "from 0 to 0.2 of an axis");
  require(human.largest_rate > 0.0, "largest_rate", human.largest_rate, "a positive rate [1/s]");
  for (const Waypoint& waypoint : human.task) {
    require(waypoint.duration > 0.0, "the duration of a way-point", waypoint.duration, "a positive time [s]");
    require(waypoint.shift.allFinite() && waypoint.turn.allFinite(), "a way-point", waypoint.shift.sum(), "numbers");
  }
}

}  // namespace

std::vector<Waypoint> teleoperationTask() {
  return {{{0.0, 0.18, 0.05}, {0.0, 0.0, 0.3}, 3.0},    {{0.0, 0.18, -0.15}, {0.0, 0.2, 0.3}, 2.5},
          {{0.10, 0.0, -0.15}, {0.0, 0.0, 0.0}, 3.0},   {{0.0, -0.18, -0.10}, {0.2, 0.0, -0.3}, 3.0},
          {{0.0, -0.18, 0.08}, {0.0, -0.2, -0.3}, 2.5}, {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 3.0}};
}

class SimulatedHuman::Implementation {
 public:
  explicit Implementation(SimulatedHumanConfiguration configuration)
      : human_(std::move(configuration)), map_(human_.device.map), random_(human_.seed) {
    validate(human_);
    task_ = scattered(human_.task.empty() ? teleoperationTask() : human_.task, random_);
    axes_from_twist_ = human_.device.map.gain.completeOrthogonalDecomposition().pseudoInverse();
    inputs_ = Eigen::VectorXd::Zero(map_.inputs());
    tremor_phase_ = Eigen::VectorXd(map_.inputs());
    for (double& phase : tremor_phase_) phase = random_.uniform(0.0, kTwoPi);
    int buttons = std::max({human_.device.enable_button, human_.start_button, human_.stop_button}) + 1;
    reading_.buttons.resize(static_cast<std::size_t>(buttons));
    const int axes = *std::max_element(human_.device.axes.begin(), human_.device.axes.end()) + 1;
    reading_.axes.resize(static_cast<std::size_t>(axes));
  }

  DeviceReading next(Nanoseconds now, const Eigen::Isometry3d& X_base_tool) {
    const double time = human_.reading_period * static_cast<double>(readings_++);
    if (!path_) {
      path_.emplace(X_base_tool, task_);
      motion_start_ = kEnabled + kRestBefore;
      rest_start_ = motion_start_ + path_->duration() + kSettle;
      release_ = rest_start_ + kRestAfter;
      stop_ = release_ + kStopAfterRelease;
    }
    seen_.push_back(X_base_tool);
    while (seen_.size() > delay() + 1) seen_.pop_front();

    const bool moving = time >= motion_start_ && time < rest_start_;
    moveHand(moving ? wishedInputs(time) : Eigen::VectorXd::Zero(inputs_.size()), time, moving);
    press(human_.device.enable_button, time >= kEnabled && time < release_);
    press(human_.start_button, time >= kStartPressed && time < kStartPressed + kPress);
    const bool stopping = time >= stop_ && time < stop_ + kPress;
    if (human_.stop_button != human_.start_button || stopping) press(human_.stop_button, stopping);
    finished_ = time >= stop_ + kEnd;

    reading_.stamp = now;
    reading_.receipt = now;
    return reading_;
  }

  bool finished() const { return finished_; }

 private:
  std::size_t delay() const {  // [readings]
    return static_cast<std::size_t>(std::llround(human_.reaction_delay / human_.reading_period));
  }

  /// u = ẋ_plan(t) + k (x_plan(t − d) ⊖ x_seen(t − d)) as inputs of the map.
  Eigen::VectorXd wishedInputs(double time) const {
    const double task_time = time - motion_start_;
    const Eigen::Isometry3d& seen = seen_.front();
    const ToolPoint meant = path_->at(task_time - human_.reaction_delay);
    Twist twist = path_->at(task_time).twist;
    twist.head<3>() += kVisualGain * (meant.pose.translation() - seen.translation());
    twist.tail<3>() += kVisualGain * rotationVector(meant.pose.linear() * seen.linear().transpose());
    return axes_from_twist_ * (twist - map_.configuration().offset);
  }

  void moveHand(const Eigen::VectorXd& wish, double time, bool moving) {
    const double reach = human_.largest_rate * human_.reading_period;
    for (Eigen::Index i = 0; i < inputs_.size(); ++i) {
      inputs_[i] += std::clamp(std::clamp(wish[i], -1.0, 1.0) - inputs_[i], -reach, reach);
      double axis = inputs_[i];
      if (moving) {
        axis += human_.tremor * (std::sin(kTwoPi * kTremorFrequency * time + tremor_phase_[i]) + random_.next());
      }
      axis = std::round(std::clamp(axis, -1.0, 1.0) * kAxisSteps) / kAxisSteps;
      reading_.axes[static_cast<std::size_t>(human_.device.axes[static_cast<std::size_t>(i)])] = axis;
    }
  }

  void press(int button, bool pressed) {
    if (button >= 0) reading_.buttons[static_cast<std::size_t>(button)] = pressed ? 1 : 0;
  }

  SimulatedHumanConfiguration human_;
  TeleopMap map_;
  GaussianNoise random_;
  std::vector<Waypoint> task_;
  Eigen::MatrixXd axes_from_twist_;
  Eigen::VectorXd inputs_;  // where the hand holds the axes, tremor apart
  Eigen::VectorXd tremor_phase_;
  std::optional<WaypointPath> path_;  // from the first pose seen
  double motion_start_ = 0.0;         // [s] since the first reading, like the next three
  double rest_start_ = 0.0;
  double release_ = 0.0;
  double stop_ = 0.0;
  std::deque<Eigen::Isometry3d> seen_;  // from one reaction delay ago until now
  std::uint64_t readings_ = 0;
  bool finished_ = false;
  DeviceReading reading_;
};

SimulatedHuman::SimulatedHuman(SimulatedHumanConfiguration configuration)
    : implementation_(std::make_unique<Implementation>(std::move(configuration))) {}
SimulatedHuman::~SimulatedHuman() = default;
SimulatedHuman::SimulatedHuman(SimulatedHuman&&) noexcept = default;
SimulatedHuman& SimulatedHuman::operator=(SimulatedHuman&&) noexcept = default;

DeviceReading SimulatedHuman::next(Nanoseconds now, const Eigen::Isometry3d& X_base_tool) {
  return implementation_->next(now, X_base_tool);
}

bool SimulatedHuman::finished() const { return implementation_->finished(); }

}  // namespace demo_logger
