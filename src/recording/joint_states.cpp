#include "joint_states.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "demo_logger/trajectory/not_a_number.h"
#include "demo_logger/trajectory/print.h"
#include "demo_logger/trajectory/quotation.h"

namespace demo_logger {
namespace {

constexpr std::size_t kQuantities = 3;  // position, velocity, effort

Nanoseconds steadyOf(const Arrival& arrival) { return arrival.steady != 0 ? arrival.steady : arrival.receipt; }

std::vector<std::string> sorted(std::vector<std::string> names) {
  std::sort(names.begin(), names.end());
  return names;
}

std::string quoted(const std::string& text) { return "'" + shortened(text) + "'"; }

}  // namespace

const std::vector<std::string> JointStates::kNone;

JointStates::JointStates(const SynchroniserConfiguration& configuration, Ledger& ledger)
    : ledger_(ledger), layout_(configuration.joints), merging_(configuration.merge_joint_states) {
  merging_rule_.alignment = Alignment::linear;
  merging_rule_.max_gap = fromSeconds(configuration.max_gap);
  merging_rule_.width = kQuantities;
  if (merging_) parts_.resize(configuration.joints.size());
}

std::optional<JointRow> JointStates::read(JointStateSample& sample, const char* rejected, const Reception& reception) {
  const Arrival& arrival = sample.arrival;
  const JointMapping* mapping = mapJoints(sample, rejected, arrival.receipt);
  if (mapping == nullptr) return std::nullopt;
  const std::optional<Nanoseconds> stamp = place(sample, reception);
  if (!stamp) return std::nullopt;
  watchPublishers(*mapping, arrival.receipt);

  const bool makes_row = mapping->complete() || (merging_ && mapping->hasFirst());
  if (!makes_row && !merging_) {
    std::vector<std::string> lacking;
    for (std::size_t i = 0; i < mapping->places.size(); ++i) {
      if (!mapping->places[i]) lacking.push_back(layout_.joints()[i]);
    }
    reportPartial(lacking, arrival.publisher, arrival.receipt);
    return std::nullopt;
  }
  std::vector<double> values = valuesOf(sample, *mapping);
  if (merging_) keepParts(*mapping, values, *stamp, reception);
  if (!makes_row) return std::nullopt;

  watchNames(*mapping, arrival);
  ready_ = true;
  const bool stamped = arrival.stamp != 0;
  if (!stamped) reportUnstamped(arrival);
  values.push_back(stamped ? toSeconds(arrival.receipt - arrival.stamp) : kNaN);
  JointRow row{
      *stamp, arrival.receipt, reception.received, steadyOf(arrival), reception.sequence, stamped, std::move(values),
      {}};
  if (!mapping->complete()) {
    for (const auto& joint_place : mapping->places) row.carried.push_back(joint_place.has_value());
  }
  return row;
}

bool JointStates::looksLikeRow(const JointStateSample& sample) const {
  if (jointsOf(sample) == 0 || whatIsWrong(sample)) return false;
  if (layout_.joints().empty() || sample.names.empty()) return true;
  return std::find(sample.names.begin(), sample.names.end(), layout_.joints().front()) != sample.names.end();
}

const JointMapping* JointStates::mapJoints(JointStateSample& sample, const char* rejected, Nanoseconds receipt) {
  const std::string& publisher = sample.arrival.publisher;
  const auto malformed = [&](const std::string& why) {
    ledger_.count(Counter::malformed_joint_states);
    ledger_.report(FaultKind::malformed_message, kJointStatesSubject, receipt,
                   [&] { return "a joint state" + ofPublisher(publisher) + " cannot be used: " + why; });
    return nullptr;
  };
  if (rejected != nullptr) return malformed(std::string("it has ") + rejected);
  if (const auto wrong = whatIsWrong(sample)) {
    return malformed(*wrong + "; every array should be empty or have one value per name");
  }
  if (sample.names.empty()) sample.names = numberedJoints(jointsOf(sample));

  const JointMapping* mapping = &layout_.map(sample.names);
  if (!mapping->distinct) return malformed("it names a joint twice: " + listOf(sample.names));
  if (layout_.joints().empty() && !sample.names.empty()) {
    layout_.learn(sample.names);
    mapping = &layout_.map(sample.names);
  }
  if (mapping->carried == 0) {
    ledger_.count(Counter::foreign_joint_states);
    ledger_.report(FaultKind::foreign_joint_state, kJointStatesSubject, receipt, [&] {
      return "a joint state" + ofPublisher(publisher) + " has none of the arm's joints " + listOf(layout_.joints()) +
             (sample.names.empty() ? ", and no others" : ", but " + listOf(sample.names));
    });
    return nullptr;
  }
  if (!mapping->others.empty()) {
    ledger_.report(FaultKind::other_joints, kJointStatesSubject, receipt, [&] {
      return "joint states" + ofPublisher(publisher) + " also have " + listOf(mapping->others) +
             ", which are not recorded; name them in the joints to record them";
    });
  }
  return mapping;
}

std::optional<Nanoseconds> JointStates::place(const JointStateSample& sample, const Reception& reception) {
  const Arrival& arrival = sample.arrival;
  switch (publishers_.place(arrival)) {
    case Placement::by_stamp:
      return arrival.stamp;
    case Placement::by_receipt:
      return arrival.receipt + reception.unstamped_shift;
    case Placement::nowhere:
      break;
  }
  ledger_.count(Counter::zero_stamps);
  ledger_.report(FaultKind::zero_stamp, kJointStatesSubject, reception.received, [&] {
    return "a joint state" + ofPublisher(arrival.publisher) +
           " came with stamp 0 from a publisher that stamped its messages before; it was dropped";
  });
  return std::nullopt;
}

void JointStates::reportUnstamped(const Arrival& arrival) {
  ledger_.report(FaultKind::unstamped, kJointStatesSubject, arrival.receipt, [&] {
    return "joint states" + ofPublisher(arrival.publisher) +
           " have no stamps: their rows are placed by receipt, and the transport delay is in them";
  });
}

void JointStates::watchPublishers(const JointMapping& mapping, Nanoseconds receipt) {
  const std::size_t publisher = publishers_.last();
  if (publishers_.nameOf(publisher).empty()) return;
  publishers_of_joint_.resize(mapping.places.size());
  for (std::size_t i = 0; i < mapping.places.size(); ++i) {
    if (!mapping.places[i]) continue;
    auto& [last, earlier] = publishers_of_joint_[i];
    if (last == publisher) continue;
    // A node that took over from another, such as a restarted driver, is alone; one that comes back is not.
    if (earlier == publisher) {
      ledger_.report(FaultKind::two_publishers, kJointStatesSubject, receipt, [&, other = *last] {
        return "joint " + layout_.joints()[i] + " is published by " + publishers_.nameOf(publisher) + " and by " +
               publishers_.nameOf(other) + ": the rows mix both; stop one of them or remap its topic";
      });
    }
    earlier = last;
    last = publisher;
  }
}

void JointStates::watchNames(const JointMapping& mapping, const Arrival& arrival) {
  if (mapping.id != last_mapping_) {
    last_mapping_ = mapping.id;
    std::vector<std::string> names = sorted(mapping.names);
    if (!last_names_.empty() && names != last_names_) {
      ledger_.report(FaultKind::names_changed, kJointStatesSubject, arrival.receipt, [&] {
        return "joint states" + ofPublisher(arrival.publisher) + " changed their joints from " + listOf(last_names_) +
               " to " + listOf(names);
      });
    }
    last_names_ = std::move(names);
  }
  if (last_frame_ && *last_frame_ != arrival.frame_id) {
    ledger_.report(FaultKind::frame_changed, kJointStatesSubject, arrival.receipt, [&] {
      return "joint states" + ofPublisher(arrival.publisher) + " changed their frame_id from " + quoted(*last_frame_) +
             " to " + quoted(arrival.frame_id);
    });
  }
  if (!last_frame_ || *last_frame_ != arrival.frame_id) last_frame_ = arrival.frame_id;
}

std::vector<double> JointStates::valuesOf(const JointStateSample& sample, const JointMapping& mapping) {
  const std::size_t joints = mapping.places.size();
  std::vector<double> values;
  values.reserve(kQuantities * joints + 1 + 2 * joints);
  const std::array<std::pair<const char*, const std::vector<double>*>, kQuantities> quantities = {
      {{"a position", &sample.position}, {"a velocity", &sample.velocity}, {"an effort", &sample.effort}}};
  for (const auto& [name, quantity] : quantities) {
    for (std::size_t i = 0; i < joints; ++i) {
      double value = kNaN;
      if (mapping.places[i] && !quantity->empty()) {
        value = (*quantity)[*mapping.places[i]];
        if (!std::isfinite(value)) {
          value = kNaN;
          ledger_.count(Counter::non_finite_values);
          ledger_.report(FaultKind::non_finite_joint, values.size(), sample.arrival.receipt, [&] {
            return "joint " + layout_.joints()[i] + " came with " + std::string(name) +
                   " that is not finite; it is recorded as NaN";
          });
        }
      }
      values.push_back(value);
    }
  }
  return values;
}

void JointStates::keepParts(const JointMapping& mapping, const std::vector<double>& values, Nanoseconds stamp,
                            const Reception& reception) {
  const std::size_t joints = mapping.places.size();
  for (std::size_t i = 1; i < joints; ++i) {
    if (!mapping.places[i]) continue;
    StreamMessage part{{values[i], values[joints + i], values[2 * joints + i]},
                       reception.sequence,
                       reception.episode,
                       0,
                       publishers_.last()};
    if (parts_[i].insert(stamp, std::move(part))) continue;
    ledger_.count(Counter::overflow);
    ledger_.report(FaultKind::overflow, kJointStatesSubject, reception.received, [&] {
      return "joint " + layout_.joints()[i] + " sent more than " + std::to_string(StreamBuffer::kCapacity) +
             " messages ahead of the rows; the oldest are lost";
    });
  }
}

void JointStates::reportPartial(const std::vector<std::string>& lacking, const std::string& publisher,
                                Nanoseconds receipt) {
  ledger_.count(Counter::partial_joint_states);
  ledger_.report(FaultKind::partial_joint_state, kJointStatesSubject, receipt, [&] {
    return "joint states" + ofPublisher(publisher) + " lack " + listOf(lacking) +
           " and make no rows; where several nodes publish the arm's joints, set merge_joint_states";
  });
}

void JointStates::fixMerged(const JointRow& first) {
  merged_.clear();
  for (std::size_t i = 0; i < first.carried.size(); ++i) {
    if (!first.carried[i]) merged_.push_back(i);
  }
}

bool JointStates::suffices(const JointRow& row) {
  std::vector<std::string> lacking;
  for (std::size_t i = 0; i < row.carried.size(); ++i) {
    if (!row.carried[i] && !std::binary_search(merged_.begin(), merged_.end(), i)) {
      lacking.push_back(layout_.joints()[i]);
    }
  }
  if (lacking.empty()) return true;
  ledger_.count(Counter::partial_joint_states);
  ledger_.report(FaultKind::partial_joint_state, kJointStatesSubject, row.receipt, [&] {
    return "joint states lack " + listOf(lacking) +
           " that they had when the episode began, and make no rows; keep the messages' joints the same";
  });
  return false;
}

void JointStates::writeMerged(Nanoseconds instant, Nanoseconds receipt, std::vector<double>& values) {
  const std::size_t joints = layout_.joints().size();
  for (const std::size_t joint : merged_) {
    double part[kQuantities];
    const Chosen chosen = chooseFrom(parts_[joint], merging_rule_, instant, part);
    for (std::size_t quantity = 0; quantity < kQuantities; ++quantity)
      values[quantity * joints + joint] = part[quantity];
    values.push_back(chosen.age);
    if (!chosen.unbridged) continue;
    ledger_.count(Counter::unbridged_gaps);
    ledger_.report(FaultKind::unbridged_joint, joint, receipt, [&] {
      return "joint " + layout_.joints()[joint] +
             " could not be interpolated: no later message came in time, or more "
             "than max_gap (" +
             print(toSeconds(merging_rule_.max_gap)) + " s) after the earlier one";
    });
  }
}

void JointStates::beginEpisode() {
  publishers_of_joint_.clear();
  merged_.clear();
}

void JointStates::prune(Nanoseconds horizon) {
  for (StreamBuffer& part : parts_) part.prune(horizon);
}

void JointStates::restartClock(std::uint64_t first) {
  for (StreamBuffer& part : parts_) {
    StreamBuffer::Messages kept = part.extractSince(first);
    part.clear();
    for (auto& [stamp, message] : kept) part.insert(stamp, std::move(message));
  }
}

std::size_t JointStates::size() const {
  std::size_t size = 0;
  for (const StreamBuffer& part : parts_) size += part.size();
  return size;
}

}  // namespace demo_logger
