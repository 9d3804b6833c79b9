#pragma once

#include <memory>
#include <string>
#include <vector>

#include "demo_logger/pipelines/human_torque_observer.h"
#include "demo_logger/recording/derived_columns.h"

namespace demo_logger {

/// The human's torque as columns of a recording, from its own positions and efforts while they are recorded:
///   tau_h_<joint> [N m or N], for every joint of the arm
/// by HumanTorqueObserver, late by its delay(). NaN where it knows nothing; why, where that lasts, is a fault.
class HumanTorqueColumns : public DerivedColumns {
 public:
  HumanTorqueColumns(const CalibratedArm& arm, const HumanTorqueObserverConfiguration& configuration);
  ~HumanTorqueColumns() override;

  /// A chain whose joints are not all recorded gets no columns, and a fault names the first.
  std::vector<Column> open(const std::vector<Column>& recorded) override;
  void append(Row& row) override;
  std::vector<Fault> faults() const override;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// The torque at the joints that a wrench at the arm makes, as a force-torque sensor measures it: Jᵀ W, as columns
///   <stream>_tau_<joint> [N m or N], for every joint below the sensor
/// beside the columns of a recorded stream of wrenches, upon the arm, at the origin and in the axes of a link.
class WrenchTorqueColumns : public DerivedColumns {
 public:
  /// `arm_to_sensor` ends at that link: its tip.
  WrenchTorqueColumns(const RobotDescription& arm_to_sensor, const std::string& stream);
  ~WrenchTorqueColumns() override;

  /// No columns where the stream is not recorded, or is not one of wrenches, which a fault says.
  std::vector<Column> open(const std::vector<Column>& recorded) override;
  void append(Row& row) override;
  std::vector<Fault> faults() const override;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace demo_logger
