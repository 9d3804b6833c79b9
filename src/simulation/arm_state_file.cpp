// How a SimulatedArm is saved and goes on from what was saved.

#include <utility>

#include "demo_logger/simulation/simulated_arm.h"
#include "demo_logger/trajectory/error.h"
#include "snapshot.h"

namespace demo_logger {
namespace {

constexpr const char* kFormat = "demo_logger_arm_state/1";

void exchangeVector(Snapshot& snapshot, const std::string& key, Eigen::Vector3d& vector) {
  Eigen::VectorXd values = vector;
  snapshot.values(key, values, {3});
  vector = values;
}

nlohmann::ordered_json parse(const std::string& text) {
  try {
    return nlohmann::ordered_json::parse(text);
  } catch (const nlohmann::json::exception& error) {
    throw ConfigurationError(std::string("state of a simulated arm: not JSON: ") + error.what());
  }
}

void expectSame(Snapshot& snapshot, const std::string& key, const std::string& expected) {
  std::string found = expected;
  snapshot.value(key, found);
  if (found == expected) return;
  throw ConfigurationError("state of a simulated arm: \"" + key + "\" is \"" + found + "\", expected \"" + expected +
                           "\", that of this arm.");
}

}  // namespace

std::string SimulatedArm::saveState() {
  Snapshot snapshot;
  exchange(snapshot);
  return snapshot.json().dump(1) + "\n";
}

void SimulatedArm::restoreState(const std::string& json, std::optional<Nanoseconds> next) {
  constexpr std::size_t kLongest = std::size_t{64} << 20U;  // [bytes] several times the longest path
  if (json.size() > kLongest) {
    throw ConfigurationError("state of a simulated arm: " + std::to_string(json.size()) +
                             " bytes, which no such state has.");
  }
  nlohmann::ordered_json parsed = parse(json);
  const auto joints = static_cast<Eigen::Index>(description_.joints.size());
  Nanoseconds shift = 0;
  if (next && parsed.is_object() && parsed.contains("next_tick")) {
    Nanoseconds saved = 0;
    Snapshot(parsed, 0, joints).stamp("next_tick", saved);
    shift = *next - saved;
  }
  Snapshot snapshot(std::move(parsed), shift, joints);
  exchange(snapshot);
}

void SimulatedArm::exchange(Snapshot& snapshot) {
  std::string joints;
  for (const ArmJoint& joint : description_.joints) joints += (joints.empty() ? "" : " ") + joint.name;
  expectSame(snapshot, "format", kFormat);
  expectSame(snapshot, "robot", description_.name);
  expectSame(snapshot, "urdf_sha256", description_.urdf_sha256);
  expectSame(snapshot, "joints", joints);
  snapshot.count("ticks", ticks_, Snapshot::kMostCounted);
  snapshot.stamp("next_tick", next_tick_);
  exchangeLoad(snapshot);

  snapshot.part("body", [&](Snapshot& inside) {
    ArmState state = body_.state();
    Eigen::VectorXd link_torque = body_.linkTorque();
    inside.value("q", state.q);
    inside.value("dq", state.dq);
    inside.valueOrNone("link_torque", link_torque);
    if (inside.reading()) restoreBody(state, link_torque);
  });
  snapshot.part("sensors", [&](Snapshot& inside) { sensors_.exchange(inside); });
  snapshot.part("controller", [&](Snapshot& inside) { controller_.exchange(inside); });
  snapshot.count("refused", refused_, Snapshot::kMostCounted);
  snapshot.value("refusals", refusals_);
  std::size_t wrenches = wrenches_.size();
  snapshot.count("wrenches", wrenches, kMostWrenches);
  if (snapshot.reading()) wrenches_.assign(wrenches, {});
  for (std::size_t i = 0; i < wrenches; ++i) {
    snapshot.part("wrench_" + std::to_string(i), [&](Snapshot& inside) { exchangeWrench(inside, wrenches_[i]); });
  }
}

void SimulatedArm::exchangeLoad(Snapshot& snapshot) {
  std::optional<BodyInertia> load = load_;
  snapshot.optional("load", load, [](Snapshot& inside, BodyInertia& body) {
    inside.value("mass", body.mass);
    exchangeVector(inside, "center", body.center);
    Eigen::VectorXd inertia = body.inertia.reshaped();
    inside.values("inertia", inertia, {9});
    body.inertia = inertia.reshaped(3, 3);
  });
  if (!snapshot.reading()) return;
  try {
    setLoad(load);
  } catch (const ModelError& error) {
    throw ConfigurationError(std::string("state of a simulated arm: ") + error.what());
  }
}

void SimulatedArm::restoreBody(const ArmState& state, const Eigen::VectorXd& link_torque) {
  try {
    body_.restore(state, link_torque);
  } catch (const ModelError& error) {
    throw ConfigurationError(std::string("state of a simulated arm: ") + error.what());
  }
}

void SimulatedArm::exchangeWrench(Snapshot& snapshot, TimedWrench& timed) {
  snapshot.value("joint", timed.wrench.joint);
  if (timed.wrench.joint < -1 || timed.wrench.joint >= static_cast<int>(description_.joints.size())) {
    Snapshot::refuse("joint", "of a wrench is " + std::to_string(timed.wrench.joint) + ", none of this arm");
  }
  exchangeVector(snapshot, "point", timed.wrench.point);
  exchangeVector(snapshot, "force", timed.wrench.force);
  exchangeVector(snapshot, "torque", timed.wrench.torque);
  snapshot.value("in_link_axes", timed.wrench.in_link_axes);
  snapshot.stamp("until", timed.until);
  snapshot.value("source", timed.source);
  if (const std::string why = whyNotApplied(timed.wrench); snapshot.reading() && !why.empty()) {
    throw ConfigurationError("state of a simulated arm: " + why + ".");
  }
}

}  // namespace demo_logger
