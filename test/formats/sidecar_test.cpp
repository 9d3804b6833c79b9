#include "demo_logger/formats/sidecar.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "demo_logger/trajectory/error.h"

namespace demo_logger {
namespace {

using Json = nlohmann::json;

Sidecar makeSidecar() {
  Sidecar sidecar;
  Metadata& metadata = sidecar.metadata;
  metadata.id = "demo_000007";
  metadata.channel = "teleoperation";
  metadata.task = "pour \"water\", 2 cups\n";
  metadata.operator_name = "Zoë";
  metadata.outcome = "success";
  metadata.status = "interrupted: clock jumped";
  metadata.start_stamp = 1'600'000'000'123'456'789;
  metadata.duration = 2.5;
  metadata.rows = 251;
  metadata.robot = {"panda", "ab12", "base_link", "tool", {"shoulder", "elbow"}};
  metadata.effort = {"link", "held", false, 0.001};
  metadata.teleop_map =
      TeleopMapMetadata{"rate", {"axis0"}, {"vx", "vy"}, {{0.5}, {0.25}}, {0.0, 0.1}, 0.05, {1.0, 1.0}};
  StreamMetadata stream;
  stream.name = "teleop_cmd";
  stream.topic = "/teleop_cmd";
  stream.type = "geometry_msgs/Twist";
  stream.publishers = {"/teleop"};
  stream.stamped = false;
  stream.align = "hold";
  stream.latency = -0.01;
  stream.received = 100;
  stream.used = 90;
  stream.late = 7;
  stream.dropped = 3;
  stream.largest_gap = 0.2;
  stream.receipt_delay = {0.001, 0.002, 0.03};
  metadata.streams = {stream};
  metadata.counters = {{"late_rows", 2}, {"rows", 18'446'744'073'709'551'615U}};
  metadata.faults = {{1'600'000'001'000'000'000, "joint states: frame_id changed.", 4, Severity::error}};
  metadata.parameters = {{"max_wait", 0.1},
                         {"autostart", true},
                         {"joints", std::vector<std::string>{"a", "b"}},
                         {"tick", std::int64_t{-3}},
                         {"offset", std::vector<double>{1.0, 2.5}},
                         {"channel", std::string("vr")}};
  metadata.original_names = {{"q_a_b", "q_a/b"}};
  metadata.software = "demo_logger 0.1.0";
  metadata.provenance = {"demo_000006.csv", {"resample --rate 50"}};
  metadata.other = {{"lab", R"({"room":[1,2]})"}};
  sidecar.columns = {{"q_elbow", "rad", Role::state, Interpolation::linear, "joint_states/position/elbow"},
                     {"u_vx", "m/s", Role::control, Interpolation::hold, "teleop_cmd/linear/x"}};
  return sidecar;
}

std::string textOf(const Sidecar& sidecar) { return sidecarText(sidecar.metadata, sidecar.columns); }

// The message of the FileError that reading `text` must raise.
std::string errorOf(const std::string& text) {
  try {
    parseSidecar(text, "demo_000007.json");
  } catch (const FileError& error) {
    return error.what();
  }
  return "no error";
}

TEST(SidecarTest, UsesTheKeysOfTheFormatInTheirOrder) {
  const auto json = toJson({}, {});
  std::vector<std::string> keys;
  for (const auto& item : json.items()) {
    keys.push_back(item.key());
  }
  EXPECT_EQ(keys, (std::vector<std::string>{"format",   "id",        "channel", "task",        "operator",
                                            "outcome",  "notes",     "status",  "start_stamp", "duration",
                                            "rows",     "columns",   "robot",   "effort",      "teleop_map",
                                            "streams",  "counters",  "faults",  "parameters",  "original_names",
                                            "software", "provenance"}));
}

TEST(SidecarTest, ReadsBackWhatItWrote) {
  const Sidecar sidecar = makeSidecar();
  const std::string text = textOf(sidecar);
  const Sidecar back = parseSidecar(text, "demo_000007.json");
  EXPECT_TRUE(back.notes.empty());
  EXPECT_EQ(textOf(back), text) << "every field, since the text has them all (next test)";
}

TEST(SidecarTest, TheTextHoldsEveryField) {
  const Json json = Json::parse(textOf(makeSidecar()));
  EXPECT_EQ(json["format"], "demo_logger/1");
  EXPECT_EQ(json["operator"], "Zoë");
  EXPECT_EQ(json["start_stamp"], Json({{"secs", 1'600'000'000}, {"nsecs", 123'456'789}}));
  EXPECT_EQ(json["rows"], 251);
  EXPECT_EQ(json["columns"][0]["name"], "time");
  EXPECT_EQ(json["columns"][1], Json({{"name", "q_elbow"},
                                      {"unit", "rad"},
                                      {"role", "state"},
                                      {"interpolation", "linear"},
                                      {"source", "joint_states/position/elbow"}}));
  EXPECT_EQ(json["robot"]["joints"], Json({"shoulder", "elbow"}));
  EXPECT_EQ(json["effort"]["timing"], "held");
  EXPECT_EQ(json["teleop_map"]["gain"], Json({{0.5}, {0.25}}));
  EXPECT_EQ(json["streams"][0]["receipt_delay"], Json({{"min", 0.001}, {"median", 0.002}, {"max", 0.03}}));
  EXPECT_EQ(json["streams"][0]["stamped"], false);
  EXPECT_EQ(json["counters"]["late_rows"], 2);
  EXPECT_EQ(json["faults"][0]["count"], 4);
  EXPECT_EQ(json["faults"][0]["severity"], "error");
  EXPECT_EQ(json["parameters"]["offset"], Json({1.0, 2.5}));
  EXPECT_EQ(json["original_names"]["q_a_b"], "q_a/b");
  EXPECT_EQ(json["provenance"]["steps"][0], "resample --rate 50");
  EXPECT_EQ(json["lab"]["room"], Json({1, 2})) << "keys of others stay";
}

TEST(SidecarTest, StampsBeforeTheEpochKeepTheirNanosecondsPositive) {
  Metadata metadata;
  metadata.start_stamp = -1;
  const auto json = toJson(metadata, {});
  EXPECT_EQ(json["start_stamp"]["secs"], -1);
  EXPECT_EQ(json["start_stamp"]["nsecs"], 999'999'999);
  EXPECT_EQ(parseSidecar(json.dump(), "x.json").metadata.start_stamp, -1);
}

TEST(SidecarTest, NumbersThatAreNotFiniteBecomeNullAndReadAsNaN) {
  Sidecar sidecar = makeSidecar();
  sidecar.metadata.streams[0].receipt_delay.median = std::numeric_limits<double>::quiet_NaN();
  sidecar.metadata.parameters["limit"] = std::numeric_limits<double>::infinity();
  const std::string text = textOf(sidecar);
  EXPECT_TRUE(Json::parse(text)["streams"][0]["receipt_delay"]["median"].is_null());
  EXPECT_TRUE(std::isnan(parseSidecar(text, "x.json").metadata.streams[0].receipt_delay.median));
}

TEST(SidecarTest, TextThatIsNotUtf8DoesNotStopTheWriting) {
  Metadata metadata;
  metadata.notes = "caf\xe9";
  EXPECT_EQ(Json::parse(sidecarText(metadata, {}))["notes"], "caf\xef\xbf\xbd") << "the replacement character";
}

TEST(SidecarTest, AFormatAndNamesAreEnough) {
  const Sidecar sidecar = parseSidecar(
      R"({"format": "demo_logger/1", "columns": [{"name": "time"}, {"name": "q_a"}, {"name": "u_vx"}]})", "bare.json");
  ASSERT_EQ(sidecar.columns.size(), 2U);
  EXPECT_EQ(sidecar.columns[0].unit, "rad");
  EXPECT_EQ(sidecar.columns[1].role, Role::control);
  EXPECT_EQ(sidecar.metadata.outcome, "unknown");
  ASSERT_EQ(sidecar.notes.size(), 1U);
  EXPECT_EQ(
      sidecar.notes[0],
      "bare.json: does not say unit, role or interpolation of 2 columns (q_a first); what is missing follows from "
      "the names.");
}

TEST(SidecarTest, ForeignKeysAndWholeNumbersWrittenAsFloatsAreFine) {
  const Sidecar sidecar =
      parseSidecar(R"({"format": "demo_logger/1", "rows": 12.0, "robot": {"colour": "red"}, "x": null})", "x.json");
  EXPECT_EQ(sidecar.metadata.rows, 12U);
  EXPECT_EQ(sidecar.metadata.other.at("x"), "null");
}

TEST(SidecarTest, AWrongTypeNamesFileAndKey) {
  EXPECT_EQ(errorOf(R"({"format": "demo_logger/1", "rows": "many"})"),
            "demo_000007.json: key `rows` is \"many\", expected a whole number, 0 or more.");
  EXPECT_EQ(errorOf(R"({"format": "demo_logger/1", "rows": -1})"),
            "demo_000007.json: key `rows` is -1, expected a whole number, 0 or more.");
  EXPECT_EQ(errorOf(R"({"format": "demo_logger/1", "robot": {"joints": [1, 2]}})"),
            "demo_000007.json: key `robot.joints` is [1,2], expected an array of texts in quotes.");
  EXPECT_EQ(errorOf(R"({"format": "demo_logger/1", "streams": [{}, {"receipt_delay": 3}]})"),
            "demo_000007.json: key `streams[1].receipt_delay` is 3, expected an object {…}.");
  EXPECT_EQ(errorOf(R"({"format": "demo_logger/1", "columns": [{"unit": "rad"}]})"),
            "demo_000007.json: key `columns[0].name` is {\"unit\":\"rad\"}, expected the column's name.");
  EXPECT_EQ(errorOf(R"({"format": "demo_logger/1", "columns": [{"name": "time", "unit": "ms"}]})"),
            "demo_000007.json: key `columns[0].unit` is \"ms\", expected s, which times always are; convert them.");
  EXPECT_EQ(errorOf(R"({"format": "demo_logger/1", "columns": [{"name": "q", "role": "observation"}]})"),
            "demo_000007.json: key `columns[0].role` is \"observation\", expected state, control or auxiliary.");
  EXPECT_EQ(errorOf(R"({"format": "demo_logger/1", "start_stamp": {"secs": 1, "nsecs": 1000000000}})"),
            "demo_000007.json: key `start_stamp.nsecs` is 1000000000, expected nanoseconds from 0 to 999999999.");
  EXPECT_EQ(errorOf(R"({"format": "demo_logger/1", "start_stamp": {"secs": 10000000000}})"),
            "demo_000007.json: key `start_stamp.secs` is 10000000000, expected seconds within 292 years of 1970.");
  EXPECT_EQ(errorOf(R"({"format": "demo_logger/1", "parameters": {"a": {"b": 1}}})"),
            "demo_000007.json: key `parameters.a` is {\"b\":1}, expected a single value or an array of numbers or of "
            "texts.");
  EXPECT_EQ(errorOf("[]"), "demo_000007.json: the content is [], expected an object {…}.");
}

TEST(SidecarTest, AnotherFormatIsRefused) {
  EXPECT_EQ(errorOf("{}"),
            "demo_000007.json: has no key `format`, expected \"demo_logger/1\". Is it the sidecar of a "
            "demonstration, of this version?");
  EXPECT_EQ(errorOf(R"({"format": "demo_logger/9"})"),
            "demo_000007.json: key `format` is \"demo_logger/9\", expected \"demo_logger/1\". Is it the sidecar of a "
            "demonstration, of this version?");
}

TEST(SidecarTest, BrokenJsonNamesTheLine) {
  EXPECT_EQ(errorOf("{\n\"format\": \"demo_logger/1\",\n\"rows\": }"),
            "demo_000007.json:3: is not valid JSON at byte 38. Was it edited by hand? A JSON checker shows the place.");
  EXPECT_EQ(errorOf("{\n\"format\": "),
            "demo_000007.json:2: is not valid JSON because it ends too early. Was the file cut?");
  EXPECT_EQ(errorOf(""), "demo_000007.json:1: is not valid JSON because it ends too early. Was the file cut?");
}

TEST(SidecarTest, DeepNestingIsRefusedBeforeItExhaustsTheStack) {
  EXPECT_EQ(errorOf(std::string(1'000'000, '[')),
            "demo_000007.json: is nested more than 64 levels deep; expected the sidecar of a demonstration.");
}

TEST(SidecarTest, AMissingFileADirectoryAndWhatNeverEndsAreNamed) {
  const auto refusalOf = [](const std::filesystem::path& path) -> std::string {
    try {
      readSidecar(path);
    } catch (const FileError& error) {
      return error.what();
    }
    return "taken";
  };
  EXPECT_NE(refusalOf("/nonexistent/demo.json"), "taken");
  EXPECT_EQ(refusalOf("/tmp"), "/tmp: is a directory, expected the JSON file beside a demonstration's CSV.");
  EXPECT_EQ(refusalOf("/dev/zero"), "/dev/zero: is a device, expected the JSON file beside a demonstration's CSV.");
}

TEST(SidecarTest, StandsBesideItsCsv) {
  EXPECT_EQ(sidecarPath("a/demo_000001.csv"), "a/demo_000001.json");
  EXPECT_EQ(sidecarPath("a/demo_000001.csv.part"), "a/demo_000001.json.part");
}

}  // namespace
}  // namespace demo_logger
