// Writes sidecars of several kinds into the folder given, for validate_sidecars.py.
#include <filesystem>
#include <iostream>
#include <limits>

#include "demo_logger/formats/sidecar.h"
#include "demo_logger/trajectory/error.h"

using demo_logger::Column;
using demo_logger::Interpolation;
using demo_logger::Metadata;
using demo_logger::Role;
using demo_logger::Severity;
using demo_logger::StreamMetadata;
using demo_logger::TeleopMapMetadata;

namespace {

Metadata makeFullMetadata() {
  Metadata metadata;
  metadata.id = "demo_000007";
  metadata.channel = "teleoperation";
  metadata.task = "pour \"water\"";
  metadata.operator_name = "Zoë";
  metadata.outcome = "failure";
  metadata.notes = "two\nlines";
  metadata.status = "interrupted: killed";
  metadata.start_stamp = 1'600'000'000'123'456'789;
  metadata.duration = 2.5;
  metadata.rows = 251;
  metadata.robot = {"arm", std::string(64, 'a'), "base_link", "tool", {"shoulder", "elbow"}};
  metadata.effort = {"link", "held", false, 0.001};
  metadata.teleop_map =
      TeleopMapMetadata{"rate", {"axis0"}, {"vx", "vy"}, {{0.5}, {0.25}}, {0.0, 0.1}, 0.05, {1.0, 1.0}};
  StreamMetadata stream;
  stream.name = "teleop_cmd";
  stream.publishers = {"/teleop"};
  stream.align = "hold";
  stream.received = 100;
  stream.receipt_delay = {0.001, std::numeric_limits<double>::quiet_NaN(), 0.03};
  metadata.streams = {stream, StreamMetadata()};
  metadata.counters = {{"late_rows", 2}};
  metadata.faults = {{1'600'000'001'000'000'000, "joint states: frame_id changed.", 4, Severity::error}};
  metadata.parameters = {{"max_wait", 0.1},
                         {"autostart", true},
                         {"joints", std::vector<std::string>{"a", "b"}},
                         {"tick", std::int64_t{-3}},
                         {"none", std::vector<double>{}},
                         {"limit", std::numeric_limits<double>::infinity()}};
  metadata.original_names = {{"q_a_b", "q_a/b"}};
  metadata.software = "demo_logger";
  metadata.provenance = {"demo_000006.csv", {"resample --rate 50"}};
  metadata.other = {{"lab", R"({"room": 12})"}};
  return metadata;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: sample_sidecars FOLDER\n";
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  const std::vector<Column> columns = {{"q_elbow", "rad", Role::state, Interpolation::linear, "joint_states"},
                                       {"hand_qx", "", Role::auxiliary, Interpolation::slerp, ""},
                                       {"u_vx", "m/s", Role::control, Interpolation::hold, ""}};
  try {
    demo_logger::writeSidecar(folder / "default.json", Metadata(), {});
    demo_logger::writeSidecar(folder / "full.json", makeFullMetadata(), columns);
  } catch (const demo_logger::Error& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
