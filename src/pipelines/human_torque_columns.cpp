#include "demo_logger/pipelines/human_torque_columns.h"

#include <cmath>
#include <optional>
#include <utility>

#include "demo_logger/formats/column_names.h"
#include "demo_logger/trajectory/not_a_number.h"
#include "demo_logger/trajectory/print.h"
#include "joint_columns.h"

namespace demo_logger {
namespace {

using Index = Eigen::Index;
using Places = std::vector<std::size_t>;

constexpr double kRoomForJitter = 1.1;  // of the stamps, under the cut-off that is proposed

/// A fault that is told once, and counted.
class CountedFault {
 public:
  void clear() { fault_.reset(); }
  template <typename Sentence>
  void count(Nanoseconds stamp, const Sentence& sentence) {
    if (fault_) {
      ++fault_->count;
    } else {
      fault_ = Fault{stamp, sentence(), 1, Severity::warning};
    }
  }
  void addTo(std::vector<Fault>& faults) const {
    if (fault_) faults.push_back(*fault_);
  }

 private:
  std::optional<Fault> fault_;
};

/// Where each joint's quantity stands in a row; nothing if one is missing, whose name then stands in `missing`.
std::optional<Places> findJoints(const std::vector<Column>& columns, const JointQuantity& quantity,
                                 const RobotDescription& robot, std::string& missing) {
  Places places;
  for (const ArmJoint& joint : robot.joints) {
    const std::optional<std::size_t> found = findJointColumn(columns, quantity, joint.name);
    if (!found) {
      missing = joint.name;
      return std::nullopt;
    }
    places.push_back(*found);
  }
  return places;
}

void take(const Row& row, const Places& places, Eigen::VectorXd& values) {
  for (std::size_t i = 0; i < places.size(); ++i) values[static_cast<Index>(i)] = row.values[places[i]];
}

void append(const Eigen::VectorXd& values, Row& row) {
  row.values.insert(row.values.end(), values.data(), values.data() + values.size());
}

std::vector<Column> torqueColumns(const RobotDescription& robot, const std::string& prefix, const std::string& source) {
  std::vector<Column> columns;
  for (const ArmJoint& joint : robot.joints) {
    const char* unit = joint.type == JointType::prismatic ? "N" : "N m";
    columns.push_back(
        {makePortable({prefix + joint.name}).names.front(), unit, Role::auxiliary, Interpolation::linear, source});
  }
  return columns;
}

std::string describe(const HumanTorqueObserver& observer) {
  return "human torque by momentum observer, " + print(observer.delay()) + " s late";
}

}  // namespace

// ---- the observer

class HumanTorqueColumns::Implementation {
 public:
  Implementation(const CalibratedArm& arm, const HumanTorqueObserverConfiguration& configuration)
      : observer_(arm, configuration),
        gravity_compensated_(configuration.gravity_compensated),
        q_(static_cast<Index>(arm.robot.joints.size())),
        effort_(q_),
        torque_(q_) {}

  std::vector<Column> open(const std::vector<Column>& recorded) {
    observer_.restart();
    last_.reset();
    for (CountedFault* fault : {&not_recorded_, &too_slow_, &no_effort_}) fault->clear();
    const std::optional<Places> positions = findJoints(recorded, kPosition, observer_.robot(), missing_);
    const std::optional<Places> efforts = findJoints(recorded, kEffort, observer_.robot(), missing_);
    recorded_ = positions && efforts;
    if (!recorded_) return {};
    positions_ = *positions;
    efforts_ = *efforts;
    return torqueColumns(observer_.robot(), "tau_h_", describe(observer_));
  }

  void append(Row& row) {
    if (!recorded_) {
      not_recorded_.count(row.stamp, [&] {
        return "human torque: joint '" + missing_ + "' of the arm is not recorded, so there are no columns tau_h_…";
      });
      return;
    }
    take(row, positions_, q_);
    take(row, efforts_, effort_);
    if (!observer_.update(row.stamp, q_, effort_, torque_)) explain(row.stamp);
    last_ = row.stamp;
    demo_logger::append(torque_, row);
  }

  std::vector<Fault> faults() const {
    std::vector<Fault> faults;
    for (const CountedFault* fault : {&not_recorded_, &too_slow_, &no_effort_}) fault->addTo(faults);
    return faults;
  }

 private:
  void explain(Nanoseconds stamp) {
    const double interval = last_ ? toSeconds(stamp - *last_) : 0.0;
    if (interval > observer_.longestInterval()) {
      too_slow_.count(stamp, [&] {
        const double cutoff = 1.0 / (VelocityFilter::kFewestSamplesPerPeriod * kRoomForJitter * interval);
        return "human torque: joint states " + print(interval) +
               " s apart are too rare for the velocity filter, which needs one every " +
               print(observer_.longestInterval()) +
               " s; tau_h_… begins anew after each. If they always come so, set human_torque/cutoff to " +
               print(std::floor(10.0 * cutoff) / 10.0) + " Hz or less.";
      });
    }
    if (gravity_compensated_) return;
    for (Index i = 0; i < effort_.size(); ++i) {
      if (!std::isnan(effort_[i])) continue;
      no_effort_.count(stamp, [&] {
        return "human torque: joint '" + observer_.robot().joints[static_cast<std::size_t>(i)].name +
               "' comes without an effort, so that tau_h_… is not known; if the arm is compensated for gravity alone, "
               "set human_torque/gravity_compensated";
      });
      return;
    }
  }

  HumanTorqueObserver observer_;
  const bool gravity_compensated_;
  bool recorded_ = false;
  std::string missing_;  // the joint that is not
  Places positions_, efforts_;
  std::optional<Nanoseconds> last_;
  Eigen::VectorXd q_, effort_, torque_;
  CountedFault not_recorded_, too_slow_, no_effort_;
};

HumanTorqueColumns::HumanTorqueColumns(const CalibratedArm& arm, const HumanTorqueObserverConfiguration& configuration)
    : implementation_(std::make_unique<Implementation>(arm, configuration)) {}
HumanTorqueColumns::~HumanTorqueColumns() = default;

std::vector<Column> HumanTorqueColumns::open(const std::vector<Column>& recorded) {
  return implementation_->open(recorded);
}
void HumanTorqueColumns::append(Row& row) { implementation_->append(row); }
std::vector<Fault> HumanTorqueColumns::faults() const { return implementation_->faults(); }

// ---- the sensor

class WrenchTorqueColumns::Implementation {
 public:
  Implementation(const RobotDescription& arm_to_sensor, std::string stream)
      : model_(arm_to_sensor),
        stream_(std::move(stream)),
        q_(model_.size()),
        torque_(model_.size()),
        jacobian_(6, model_.size()) {}

  std::vector<Column> open(const std::vector<Column>& recorded) {
    fault_.clear();
    const RobotDescription& robot = model_.description();
    const std::optional<Places> positions = findJoints(recorded, kPosition, robot, missing_);
    has_wrench_ = findWrench(recorded);
    recorded_ = positions && has_wrench_;
    if (!recorded_) return {};
    positions_ = *positions;
    return torqueColumns(robot, stream_ + "_tau_", "torque of " + stream_ + " upon link " + robot.tip);
  }

  void append(Row& row) {
    if (!recorded_) {
      fault_.count(row.stamp, [&] { return whyNot(); });
      return;
    }
    take(row, positions_, q_);
    Eigen::Matrix<double, 6, 1> wrench;
    for (std::size_t i = 0; i < wrench_.size(); ++i) wrench[static_cast<Index>(i)] = row.values[wrench_[i]];
    Eigen::Isometry3d X_base_sensor;
    if (wrench.allFinite() && model_.forwardKinematics(q_, X_base_sensor) && model_.jacobian(q_, jacobian_)) {
      const Eigen::Matrix3d R = X_base_sensor.linear();
      torque_.noalias() = jacobian_.topRows<3>().transpose() * (R * wrench.head<3>());
      torque_.noalias() += jacobian_.bottomRows<3>().transpose() * (R * wrench.tail<3>());
    } else {
      torque_.setConstant(kNaN);
    }
    demo_logger::append(torque_, row);
  }

  std::vector<Fault> faults() const {
    std::vector<Fault> faults;
    fault_.addTo(faults);
    return faults;
  }

 private:
  std::string whyNot() const {
    const std::string consequence = ", so the torque of " + stream_ + " at the joints is not known";
    return has_wrench_ ? "joint '" + missing_ + "' of the arm is not recorded" + consequence
                       : "stream " + stream_ + " is not recorded as a wrench" + consequence +
                             "; is it a geometry_msgs/WrenchStamped, and was it published when the episode began?";
  }

  bool findWrench(const std::vector<Column>& recorded) {
    wrench_.clear();
    for (const char* component : {"_fx", "_fy", "_fz", "_tx", "_ty", "_tz"}) {
      for (std::size_t i = 0; i < recorded.size(); ++i) {
        if (recorded[i].name == stream_ + component) wrench_.push_back(i);
      }
    }
    return wrench_.size() == 6;
  }

  RobotModel model_;
  const std::string stream_;
  bool recorded_ = false;
  bool has_wrench_ = false;
  std::string missing_;  // the joint that is not recorded
  Places positions_, wrench_;
  Eigen::VectorXd q_, torque_;
  Eigen::MatrixXd jacobian_;
  CountedFault fault_;
};

WrenchTorqueColumns::WrenchTorqueColumns(const RobotDescription& arm_to_sensor, const std::string& stream)
    : implementation_(std::make_unique<Implementation>(arm_to_sensor, stream)) {}
WrenchTorqueColumns::~WrenchTorqueColumns() = default;

std::vector<Column> WrenchTorqueColumns::open(const std::vector<Column>& recorded) {
  return implementation_->open(recorded);
}
void WrenchTorqueColumns::append(Row& row) { implementation_->append(row); }
std::vector<Fault> WrenchTorqueColumns::faults() const { return implementation_->faults(); }

}  // namespace demo_logger
