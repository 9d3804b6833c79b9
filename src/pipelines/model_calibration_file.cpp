#include <algorithm>
#include <array>
#include <charconv>
#include <string>
#include <vector>

#include "demo_logger/formats/atomic_file.h"
#include "demo_logger/pipelines/model_calibration.h"
#include "demo_logger/trajectory/error.h"
#include "strict_yaml.h"

namespace demo_logger {
namespace {

constexpr const char* kFormat = "demo_logger_model/1";
constexpr const char* kDeviation = "_deviation";

const StrictYaml::Range kTorque = {-1e6, 1e6, "a number from -1000000 to 1000000 [N m or N]"};
const StrictYaml::Range kFriction = {0.0, 1e6, "a number from 0 to 1000000 [N m or N]"};
const StrictYaml::Range kDamping = {0.0, 1e6, "a number from 0 to 1000000 [N m s/rad or N s/m]"};
const StrictYaml::Range kFrictionVelocity = {1e-9, 1000.0, "a number above 0, up to 1000 [rad/s or m/s]"};
const StrictYaml::Range kMotorInertia = {0.0, 1e5, "a number from 0 to 100000 [kg m² or kg]"};
const StrictYaml::Range kDeviationOfAny = {0.0, 1e9, "a number from 0 to 1000000000"};
const StrictYaml::Range kMass = {-1000.0, 1000.0, "a number from -1000 to 1000 [kg]"};
const StrictYaml::Range kBodyMass = {1e-9, 1000.0, "a number above 0, up to 1000 [kg]"};
const StrictYaml::Range kCenter = {-10.0, 10.0, "a number from -10 to 10 [m]"};
const StrictYaml::Range kInertia = {-1e5, 1e5, "a number from -100000 to 100000 [kg m²]"};

CalibratedValue readValue(const StrictYaml& yaml, const std::string& key, const StrictYaml::Range& range) {
  return {yaml.number(key, range), yaml.has(key + kDeviation) ? yaml.number(key + kDeviation, kDeviationOfAny) : 0.0};
}

std::optional<CalibratedValue> readIfThere(const StrictYaml& yaml, const std::string& key,
                                           const StrictYaml::Range& range) {
  if (yaml.has(key)) return readValue(yaml, key, range);
  if (yaml.has(key + kDeviation)) return readValue(yaml, key, range);  // refuses: what would it be the deviation of?
  return std::nullopt;
}

template <std::size_t count>
void readValues(const StrictYaml& yaml, const std::string& key, const StrictYaml::Range& range,
                std::array<CalibratedValue, count>& values) {
  const std::vector<double> numbers = yaml.numbers(key, count, range);
  std::vector<double> deviations(count, 0.0);
  if (yaml.has(key + kDeviation)) deviations = yaml.numbers(key + kDeviation, count, kDeviationOfAny);
  for (std::size_t i = 0; i < count; ++i) values[i] = {numbers[i], deviations[i]};
}

CalibratedBody readBody(const StrictYaml& yaml, const StrictYaml::Range& mass) {
  yaml.allow({"mass", "mass_deviation", "center", "center_deviation", "inertia", "inertia_deviation"});
  CalibratedBody body;
  body.mass = readValue(yaml, "mass", mass);
  readValues(yaml, "center", kCenter, body.center);
  if (yaml.has("inertia") || yaml.has("inertia_deviation")) readValues(yaml, "inertia", kInertia, body.inertia);
  return body;
}

JointCalibration readJoint(const StrictYaml& yaml) {
  yaml.allow({"torque_bias", "torque_bias_deviation", "damping", "damping_deviation", "friction", "friction_deviation",
              "friction_velocity", "motor_inertia", "motor_inertia_deviation"});
  JointCalibration joint;
  joint.torque_bias = readIfThere(yaml, "torque_bias", kTorque);
  joint.damping = readIfThere(yaml, "damping", kDamping);
  joint.friction = readIfThere(yaml, "friction", kFriction);
  if (yaml.has("friction_velocity")) joint.friction_velocity = yaml.number("friction_velocity", kFrictionVelocity);
  joint.motor_inertia = readIfThere(yaml, "motor_inertia", kMotorInertia);
  return joint;
}

/// Nine significant digits, with `.` whatever the locale.
std::string digits(double number) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), number, std::chars_format::general, 9).ptr;
  return {text.data(), end};
}

/// The emitter with what the file says beside its numbers.
class Writer {
 public:
  Writer() { yaml_ << YAML::BeginMap; }

  void begin(const std::string& key, const std::string& comment = "") {
    yaml_ << YAML::Key << key;
    if (!comment.empty()) yaml_ << YAML::Comment(comment);
    yaml_ << YAML::Value << YAML::BeginMap;
  }
  void end() { yaml_ << YAML::EndMap; }

  void text(const std::string& key, const std::string& value, const std::string& comment = "") {
    yaml_ << YAML::Key << key << YAML::Value << value;
    if (!comment.empty()) yaml_ << YAML::Comment(comment);
  }
  void number(const std::string& key, double value, const std::string& unit) {
    yaml_ << YAML::Key << key << YAML::Value << digits(value) << YAML::Comment("[" + unit + "]");
  }
  void value(const std::string& key, const CalibratedValue& value, const std::string& unit) {
    number(key, value.value, unit);
    if (value.deviation > 0.0) yaml_ << YAML::Key << key + kDeviation << YAML::Value << digits(value.deviation);
  }
  template <std::size_t count>
  void values(const std::string& key, const std::array<CalibratedValue, count>& values, const std::string& comment) {
    yaml_ << YAML::Key << key << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (const CalibratedValue& entry : values) yaml_ << digits(entry.value);
    yaml_ << YAML::EndSeq << YAML::Comment(comment);
    if (std::none_of(values.begin(), values.end(), [](const auto& entry) { return entry.deviation > 0.0; })) return;
    yaml_ << YAML::Key << key + kDeviation << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (const CalibratedValue& entry : values) yaml_ << digits(entry.deviation);
    yaml_ << YAML::EndSeq;
  }

  std::string finish() {
    yaml_ << YAML::EndMap;
    return std::string(yaml_.c_str()) + "\n";
  }

 private:
  YAML::Emitter yaml_;
};

void writeBody(Writer& writer, const CalibratedBody& body) {
  writer.value("mass", body.mass, "kg");
  writer.values("center", body.center, "[m]");
  const bool is_point = std::all_of(body.inertia.begin(), body.inertia.end(), [](const CalibratedValue& entry) {
    return entry.value == 0.0 && entry.deviation == 0.0;
  });
  if (!is_point) writer.values("inertia", body.inertia, "[kg m^2] xx, xy, xz, yy, yz, zz about the centre of mass");
}

}  // namespace

ModelCalibration readModelCalibration(const std::filesystem::path& path) {
  const StrictYaml yaml = StrictYaml::read(path.string());
  yaml.allow({"format", "tip", "side", "payload", "joints", "bodies"});
  ModelCalibration calibration;
  if (yaml.has("format")) yaml.word("format", {kFormat});  // else refused below, after what is plainly wrong
  if (yaml.has("tip")) calibration.tip = yaml.text("tip");
  if (yaml.has("side")) calibration.side = yaml.word("side", {"motor", "link"});
  if (yaml.has("payload")) calibration.payload = readBody(yaml.mapping("payload"), kMass);
  if (yaml.has("joints")) {
    const StrictYaml joints = yaml.mapping("joints");
    for (const std::string& name : joints.keys()) calibration.joints[name] = readJoint(joints.mapping(name));
  }
  if (yaml.has("bodies")) {
    const StrictYaml bodies = yaml.mapping("bodies");
    for (const std::string& name : bodies.keys()) calibration.bodies[name] = readBody(bodies.mapping(name), kBodyMass);
  }
  yaml.word("format", {kFormat});
  return calibration;
}

std::string textOf(const ModelCalibration& calibration) {
  Writer writer;
  writer.text("format", kFormat);
  if (!calibration.tip.empty()) writer.text("tip", calibration.tip, "frame of the payload");
  writer.text("side", calibration.side, "of the gears where efforts show the biases and friction below");
  if (calibration.payload) {
    writer.begin("payload", "beyond what the URDF has at the tip; below zero: less");
    writeBody(writer, *calibration.payload);
    writer.end();
  }
  if (!calibration.joints.empty()) {
    writer.begin("joints");
    for (const auto& [name, joint] : calibration.joints) {
      writer.begin(name);
      if (joint.torque_bias) writer.value("torque_bias", *joint.torque_bias, "N m or N");
      if (joint.damping) writer.value("damping", *joint.damping, "N m s/rad or N s/m");
      if (joint.friction) writer.value("friction", *joint.friction, "N m or N");
      if (joint.friction_velocity) writer.number("friction_velocity", *joint.friction_velocity, "rad/s or m/s");
      if (joint.motor_inertia) writer.value("motor_inertia", *joint.motor_inertia, "kg m^2 or kg");
      writer.end();
    }
    writer.end();
  }
  if (!calibration.bodies.empty()) {
    writer.begin("bodies", "instead of the URDF's, with all that the joint moves up to the next");
    for (const auto& [name, body] : calibration.bodies) {
      writer.begin(name);
      writeBody(writer, body);
      writer.end();
    }
    writer.end();
  }
  return writer.finish();
}

void writeModelCalibration(const std::filesystem::path& path, const ModelCalibration& calibration, bool overwrite) {
  writeFileAtomically(path, textOf(calibration), overwrite);
}

}  // namespace demo_logger
