// What a simulated arm says about its control loop and its commands.

#include "src/nodes/simulated_arm_node.h"

namespace demo_logger {
namespace {

constexpr double kDiagnosticsPeriod = 1.0;   // [s]
constexpr double kToleratedOverruns = 0.01;  // of the ticks

}  // namespace

void SimulatedArmNode::startDiagnostics(ros::NodeHandle& node) {
  diagnostics_.setHardwareID("simulated " + parameters_.robot.name);
  diagnostics_.add("control loop", this, &SimulatedArmNode::diagnoseLoop);
  diagnostics_.add("commands", this, &SimulatedArmNode::diagnoseCommands);
  if (!parameters_.arm.surroundings.empty()) {
    diagnostics_.add("surroundings", [this](diagnostic_updater::DiagnosticStatusWrapper& s) { diagnoseStart(s); });
  }
  diagnostics_timer_ = node.createWallTimer(ros::WallDuration(kDiagnosticsPeriod),
                                            [this](const ros::WallTimerEvent&) { diagnostics_.force_update(); });
}

void SimulatedArmNode::report(TickClock& clock, const ArmTick& tick, std::uint64_t dropped) {
  const std::lock_guard<std::mutex> lock(mutex_);
  report_.ticks = tick.index + 1;
  report_.overruns = clock.overruns();
  report_.jumps = clock.jumps();
  report_.largest_delay = std::max(report_.largest_delay, clock.largestDelay());
  clock.forgetLargestDelay();
  report_.refused = arm_.refused();
  report_.faults = faults_.counters();
  report_.dropped += dropped;
  report_.mode = toString(tick.applied.mode);
  report_.q = tick.truth.q;
  report_.reason = tick.applied.reason;
  report_.clock_mismatches = arm_.controller().clockMismatches();
}

void SimulatedArmNode::diagnoseLoop(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using Status = diagnostic_msgs::DiagnosticStatus;
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::uint64_t ticks = report_.ticks - last_report_.ticks;
  const std::uint64_t overruns = report_.overruns - last_report_.overruns;
  if (report_.paused) {
    status.summary(Status::OK, "paused");
  } else if (static_cast<double>(overruns) > kToleratedOverruns * static_cast<double>(ticks)) {
    status.summaryf(Status::WARN, "%lu of the last %lu control ticks started more than a period late", overruns, ticks);
  } else if (report_.jumps != last_report_.jumps) {
    status.summary(Status::WARN, "the loop stalled or its clock jumped; simulated time went on from now");
  } else {
    status.summary(Status::OK, "in time");
  }
  status.add("ticks", report_.ticks);
  status.add("overruns", report_.overruns);
  status.add("stalls and clock jumps", report_.jumps);
  status.add("largest delay of a tick [ms]", toSeconds(report_.largest_delay) * 1e3);
  const JointStateFaults::Counters& faults = report_.faults;
  status.add("joint state messages made", faults.messages);
  status.add("of them dropped on purpose", faults.dropped);
  status.add("duplicated on purpose", faults.duplicated);
  status.add("sent without stamp on purpose", faults.zero_stamped);
  status.add("sent in another order on purpose", faults.permuted);
  report_.largest_delay = 0;
  last_report_ = report_;
}

void SimulatedArmNode::diagnoseStart(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  using Status = diagnostic_msgs::DiagnosticStatus;
  if (overlaps_.empty()) {
    status.summary(Status::OK, "the arm started clear of floor and obstacles");
  } else {
    status.summary(Status::WARN, "at the start " + overlaps_.front());
  }
  for (const std::string& overlap : overlaps_) status.add("at the start", overlap);
}

void SimulatedArmNode::diagnoseCommands(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using Status = diagnostic_msgs::DiagnosticStatus;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (report_.refused != refused_told_) {
    status.summary(Status::WARN, std::to_string(report_.refused - refused_told_) +
                                     " refused lately, the last: " + report_.last_refusal);
    refused_told_ = report_.refused;
  } else if (report_.clock_mismatches.empty()) {
    status.summary(Status::OK, report_.reason.empty() ? "as asked" : report_.reason);
  } else {
    status.summary(Status::WARN, report_.clock_mismatches.front());
  }
  status.add("control mode", report_.mode);
  status.add("refused", report_.refused);
  status.add("dropped, more than a tick can take", report_.dropped);
  for (const std::string& mismatch : report_.clock_mismatches) status.add("clock", mismatch);
}

}  // namespace demo_logger
