#include "demo_logger/simulation/simulated_hand.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "demo_logger/simulation/gaussian_noise.h"
#include "demo_logger/trajectory/error.h"
#include "print.h"
#include "waypoint_path.h"

namespace demo_logger {
namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr double kLatency = 0.01;            // [s] that the hand must bear
constexpr double kTremorLever = 1.0 / 30.0;  // [m]
// The course of a task [s].
constexpr double kStartPressed = 0.1;
constexpr double kPress = 0.2;
constexpr double kGrasp = 1.0;
constexpr double kRestBefore = 0.25;
constexpr double kSettle = 0.5;
constexpr double kHandsOff = 1.5;
constexpr double kEnd = 0.5;  // after the stop button was pressed

const std::vector<std::pair<std::string, HandTask>>& tasks() {
  static const std::vector<std::pair<std::string, HandTask>> all{{"reach",
                                                                  {{{{0.05, 0.24, 0.08}, {0.0, 0.0, 0.4}, 1.0},
                                                                    {{0.05, -0.12, 0.0}, {0.1, 0.0, -0.2}, 1.2},
                                                                    {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 0.9}},
                                                                   0.0}},
                                                                 {"arc",
                                                                  {{{{0.0, 0.15, 0.15}, {0.0, 0.1, 0.3}, 1.0},
                                                                    {{0.0, 0.30, 0.0}, {0.0, 0.0, 0.6}, 1.0},
                                                                    {{0.08, 0.15, -0.10}, {0.0, -0.1, 0.3}, 1.0},
                                                                    {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 1.0}},
                                                                   0.5}},
                                                                 {"peg",
                                                                  {{{{0.08, 0.20, -0.04}, {0.0, 0.1, 0.3}, 1.0},
                                                                    {{0.085, 0.205, -0.05}, {0.0, 0.0, 0.3}, 0.7},
                                                                    {{0.085, 0.205, -0.14}, {0.0, 0.0, 0.3}, 1.0},
                                                                    {{0.085, 0.205, -0.01}, {0.0, 0.0, 0.3}, 0.8},
                                                                    {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 1.0}},
                                                                   0.0}}};
  return all;
}

void require(bool holds, const std::string& field, double value, const std::string& unit, const std::string& expected) {
  if (holds && std::isfinite(value)) return;
  throw ConfigurationError("simulated hand: " + field + " is " + print(value) + unit + ", expected " + expected + ".");
}

void requireDamping(const std::string& field, double damping, double stiffness, const std::string& unit) {
  require(damping >= kLatency * stiffness && damping <= 1000.0, field, damping, unit,
          "from " + print(kLatency * stiffness) + " to 1000" + unit + " with a stiffness of " + print(stiffness) +
              ", or a hand that sees the arm " + print(1e3 * kLatency) + " ms late would swing up");
}

void validate(const SimulatedHandConfiguration& hand) {
  require(hand.stiffness >= 0.0 && hand.stiffness <= 10000.0, "stiffness", hand.stiffness, " N/m",
          "from 0 to 10000 N/m");
  require(hand.turning_stiffness >= 0.0 && hand.turning_stiffness <= 1000.0, "turning_stiffness",
          hand.turning_stiffness, " N m/rad", "from 0 to 1000 N m/rad");
  requireDamping("damping", hand.damping, hand.stiffness, " N s/m");
  requireDamping("turning_damping", hand.turning_damping, hand.turning_stiffness, " N m s/rad");
  require(hand.largest_force > 0.0, "largest_force", hand.largest_force, " N", "a force above 0");
  require(hand.largest_torque > 0.0, "largest_torque", hand.largest_torque, " N m", "a torque above 0");
  require(hand.grasp_ramp > 0.0 && hand.grasp_ramp <= 10.0, "grasp_ramp", hand.grasp_ramp, " s",
          "above 0, at most 10 s");
  require(hand.release_ramp > 0.0 && hand.release_ramp <= 10.0, "release_ramp", hand.release_ramp, " s",
          "above 0, at most 10 s");
  require(hand.tremor >= 0.0 && hand.tremor <= 20.0, "tremor", hand.tremor, " N", "from 0 to 20 N");
  require(hand.task.overlap >= 0.0 && hand.task.overlap <= 0.9, "overlap", hand.task.overlap, "", "from 0 to 0.9");
  for (const Waypoint& waypoint : hand.task.waypoints) {
    require(waypoint.duration > 0.0, "the duration of a way-point", waypoint.duration, " s", "a positive time");
    require(waypoint.shift.allFinite() && waypoint.turn.allFinite(), "a way-point", waypoint.shift.sum(), "",
            "numbers");
  }
}

/// Three sines on each of six axes.
class Tremor {
 public:
  Tremor(double force, GaussianNoise& random) : force_(force) {
    constexpr double kSlowest = 7.0;  // [Hz]
    constexpr double kFastest = 11.0;
    for (auto& axis : sines_) {
      for (Sine& sine : axis) sine = {random.uniform(kSlowest, kFastest), random.uniform(0.0, kTwoPi)};
    }
  }

  TipWrench at(double time) const {
    Eigen::Matrix<double, 6, 1> values = Eigen::Matrix<double, 6, 1>::Zero();
    for (std::size_t axis = 0; axis < sines_.size(); ++axis) {
      for (const Sine& sine : sines_[axis]) {
        values[static_cast<Eigen::Index>(axis)] +=
            std::sin(kTwoPi * sine.frequency * time + sine.phase) / static_cast<double>(sines_[axis].size());
      }
    }
    return {force_ * values.head<3>(), force_ * kTremorLever * values.tail<3>()};
  }

 private:
  struct Sine {
    double frequency = 0.0;  // [Hz]
    double phase = 0.0;
  };
  double force_;
  std::array<std::array<Sine, 3>, 6> sines_;
};

Eigen::Vector3d bounded(const Eigen::Vector3d& vector, double largest) {
  const double norm = vector.norm();
  return norm > largest ? Eigen::Vector3d(vector * (largest / norm)) : vector;
}

}  // namespace

HandTask handTask(const std::string& name) {
  std::string known;
  for (const auto& [known_name, task] : tasks()) {
    if (known_name == name) return task;
    known += (known.empty() ? "" : ", ") + known_name;
  }
  throw ConfigurationError("simulated hand: task \"" + name + "\" is not known, expected one of " + known + ".");
}

std::vector<std::string> handTaskNames() {
  std::vector<std::string> names;
  for (const auto& task : tasks()) names.push_back(task.first);
  return names;
}

class SimulatedHand::Implementation {
 public:
  explicit Implementation(const SimulatedHandConfiguration& configuration)
      : hand_(configuration), random_(validated(configuration).seed), tremor_(hand_.tremor, random_) {
    hand_.task.waypoints = scattered(hand_.task.waypoints, random_);
    const WaypointPath path(Eigen::Isometry3d::Identity(), hand_.task.waypoints, hand_.task.overlap);
    motion_ = kGrasp + hand_.grasp_ramp + kRestBefore;
    release_ = motion_ + path.duration() + kSettle;
    stop_ = release_ + hand_.release_ramp + kHandsOff;
  }

  HandAction act(Nanoseconds now, const SeenTool& tool) {
    if (!start_) start_ = now;
    const double time = toSeconds(now - *start_);
    HandAction action;
    action.start_pressed = time >= kStartPressed && time < kStartPressed + kPress;
    action.stop_pressed = time >= stop_ && time < stop_ + kPress;
    finished_ = time >= duration();
    const double closed =
        minimumJerk((time - kGrasp) / hand_.grasp_ramp) * (1.0 - minimumJerk((time - release_) / hand_.release_ramp));
    if (time < kGrasp || time >= release_ + hand_.release_ramp || slipped_) return action;
    if (!path_) path_.emplace(tool.X_base_tool, hand_.task.waypoints, hand_.task.overlap);
    const ToolPoint plan = path_->at(time - motion_);
    slipped_ = slips(plan, tool);
    if (slipped_) {
      stop_ = time + kHandsOff;
      return action;
    }
    action.holds = true;
    action.wrench = grip(plan, tool, time, closed);
    return action;
  }

  bool finished() const { return finished_; }
  bool slipped() const { return slipped_; }
  double duration() const { return stop_ + kEnd; }

 private:
  /// No hand holds on to a tool that flings about: it gives up before the two swing each other up.
  static bool slips(const ToolPoint& plan, const SeenTool& seen) {
    constexpr double kFarthest = 0.3;   // [m]
    constexpr double kFastest = 3.0;    // [m/s]
    constexpr double kQuickest = 15.0;  // [rad/s]
    const Eigen::Matrix<double, 6, 1> slow = plan.twist - seen.twist;
    return !((plan.pose.translation() - seen.X_base_tool.translation()).norm() < kFarthest &&
             slow.head<3>().norm() < kFastest && slow.tail<3>().norm() < kQuickest);
  }

  static const SimulatedHandConfiguration& validated(const SimulatedHandConfiguration& hand) {
    validate(hand);
    return hand;
  }

  TipWrench grip(const ToolPoint& plan, const SeenTool& seen, double time, double closed) const {
    const Eigen::Matrix<double, 6, 1> slow = plan.twist - seen.twist;
    const Eigen::Matrix3d R_seen_plan = plan.pose.linear() * seen.X_base_tool.linear().transpose();
    const Eigen::Vector3d force =
        hand_.stiffness * (plan.pose.translation() - seen.X_base_tool.translation()) + hand_.damping * slow.head<3>();
    const Eigen::Vector3d torque =
        hand_.turning_stiffness * rotationVector(R_seen_plan) + hand_.turning_damping * slow.tail<3>();
    const TipWrench tremor = tremor_.at(time);
    return {closed * bounded(force + tremor.force, hand_.largest_force),
            closed * bounded(torque + tremor.torque, hand_.largest_torque)};
  }

  SimulatedHandConfiguration hand_;
  GaussianNoise random_;
  Tremor tremor_;
  double motion_ = 0.0;  // [s] since the first call, like the next two
  double release_ = 0.0;
  double stop_ = 0.0;
  std::optional<Nanoseconds> start_;
  std::optional<WaypointPath> path_;  // from where the tool was grasped
  bool slipped_ = false;
  bool finished_ = false;
};

SimulatedHand::SimulatedHand(const SimulatedHandConfiguration& configuration)
    : implementation_(std::make_unique<Implementation>(configuration)) {}
SimulatedHand::~SimulatedHand() = default;
SimulatedHand::SimulatedHand(SimulatedHand&&) noexcept = default;
SimulatedHand& SimulatedHand::operator=(SimulatedHand&&) noexcept = default;

HandAction SimulatedHand::act(Nanoseconds now, const SeenTool& tool) { return implementation_->act(now, tool); }
bool SimulatedHand::finished() const { return implementation_->finished(); }
bool SimulatedHand::slipped() const { return implementation_->slipped(); }
double SimulatedHand::duration() const { return implementation_->duration(); }

}  // namespace demo_logger
