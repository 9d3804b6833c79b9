// URDF text that nobody wrote on purpose: whatever comes in, there is an arm or one sentence, never a crash.

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "demo_logger/robot/robot_description.h"
#include "demo_logger/robot/robot_model.h"
#include "demo_logger/trajectory/error.h"
#include "test/robot/own_arms.h"
#include "test/robot/real_arms.h"

namespace demo_logger {
namespace {

std::string readText(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// A serial arm of `size` links, each a joint further from the base.
std::string longArm(int size, const std::string& beside = "") {
  std::string urdf = "<robot name='r'><link name='l0'/>";
  for (int i = 1; i < size; ++i) {
    const std::string parent = std::to_string(i - 1), child = std::to_string(i);
    urdf += "<link name='l" + child + "'/><joint name='j" + child + "' type='" + (i == 1 ? "continuous" : "fixed") +
            "'><parent link='l" + parent + "'/><child link='l" + child + "'/></joint>";
  }
  return urdf + beside + "</robot>";
}

std::string faultOf(const std::string& urdf, const DescriptionOptions& options = {}) {
  try {
    describeRobot(urdf, options);
  } catch (const ModelError& error) {
    return error.what();
  }
  return "no error";
}

TEST(UrdfHostileTest, AChainOfLinksBeyondAllRobotsIsRefusedNotFollowed) {
  EXPECT_EQ(faultOf(longArm(100000)), "robot description: the URDF has more than 5000 links, expected one robot");
  EXPECT_EQ(faultOf(longArm(5000)), "no error");
  EXPECT_EQ(faultOf(longArm(4999, "<link name='alone'/>")),
            "robot description: not a valid URDF: Failed to find root link: Two root links found: [alone] and [l0]");
}

TEST(UrdfHostileTest, ElementsWithinElementsWithoutEndAreRefused) {
  std::string nested = "<robot name='r'>";
  for (int level = 0; level < 1000000; ++level) nested += "<link>";
  EXPECT_EQ(faultOf(nested), "robot description: not a valid URDF: elements are nested more than 100 deep, at <link>");
}

TEST(UrdfHostileTest, ManyJointsAreAnArmToo) {
  std::string urdf = longArm(200);
  for (std::size_t at = urdf.find("'fixed'"); at != std::string::npos; at = urdf.find("'fixed'", at)) {
    urdf.replace(at, 7, "'continuous'");
  }
  const RobotModel model(describeRobot(urdf, {}));
  ASSERT_EQ(model.size(), 199);
  EXPECT_TRUE(model.forwardKinematics(Eigen::VectorXd::Constant(199, 0.1)).matrix().allFinite());
}

/// A text with one random change: cut off, a piece lost, doubled or moved, a byte or a value replaced.
class Mutation {
 public:
  explicit Mutation(unsigned seed) : generator_(seed) {}

  std::string operator()(std::string text) {
    switch (upTo(6)) {
      case 0:
        return text.substr(0, upTo(text.size()));
      case 1:
        return text.erase(upTo(text.size()), upTo(40));
      case 2: {
        const std::string piece = text.substr(upTo(text.size()), upTo(400));
        return text.insert(upTo(text.size()), piece);
      }
      case 3:
        text[upTo(text.size() - 1)] = static_cast<char>(upTo(255));
        return text;
      case 4:
        return withValue(text, [this](const std::string&) { return worst(); });
      case 5:  // the value of another attribute: links and joints that meet where they should not
        return withValue(text, [&](const std::string&) {
          std::string other;
          withValue(text, [&other](const std::string& found) { return other = found; });
          return other;
        });
      default:
        return withValue(text, [](const std::string& value) { return "-" + value; });
    }
  }

 private:
  std::size_t upTo(std::size_t last) { return std::uniform_int_distribution<std::size_t>(0, last)(generator_); }

  std::string worst() {
    static const std::array<const char*, 16> values = {"",     "nan",     "inf",    "-1e999",  "1e308", "1,5",
                                                       "0 0",  "0 0 0 0", "0x10",   "${x}",    "&amp;", "&#0;",
                                                       "true", "--1",     "1e-320", "floating"};
    return values[upTo(values.size() - 1)];
  }

  /// Replaces what stands between the quotes of one attribute.
  template <typename Change>
  std::string withValue(std::string text, const Change& change) {
    const std::size_t begin = text.find("=\"", upTo(text.size()));
    if (begin == std::string::npos) return text;
    const std::size_t end = text.find('"', begin + 2);
    if (end == std::string::npos) return text;
    const std::string value = text.substr(begin + 2, end - begin - 2);
    return text.replace(begin + 2, end - begin - 2, change(value));
  }

  std::mt19937 generator_;
};

/// Either one sentence, or an arm whose model answers with finite numbers or says that it cannot.
void expectArmOrSentence(const std::string& urdf, const DescriptionOptions& options) {
  try {
    const RobotModel model(describeRobot(urdf, options));
    const Eigen::VectorXd q = Eigen::VectorXd::Constant(model.size(), 0.3);
    EXPECT_TRUE(model.forwardKinematics(q).matrix().allFinite()) << urdf;
    EXPECT_TRUE(model.jacobian(q).allFinite()) << urdf;
    EXPECT_TRUE(!model.description().has_inertia || model.motorTorque(q, q, q).allFinite()) << urdf;
  } catch (const Error& error) {
    EXPECT_GT(std::string(error.what()).size(), 20u) << urdf;
  }
}

void expectSurvival(const std::string& text, const DescriptionOptions& options, unsigned mutants) {
  for (unsigned seed = 0; seed < mutants; ++seed) {
    Mutation mutate(seed);
    std::string mutant = mutate(text);
    if (seed % 2 == 0) mutant = mutate(mutant);
    expectArmOrSentence(mutant, options);
  }
}

TEST(UrdfHostileTest, EveryPrefixOfAUrdfGetsItsSentence) {
  const std::string text = readText(ownUrdf("two_link"));
  const std::size_t whole = text.rfind("</robot>") + 8;
  for (std::size_t length = 0; length < whole; ++length) {
    EXPECT_NE(faultOf(text.substr(0, length)), "no error") << "the first " << length << " bytes";
  }
}

TEST(UrdfHostileTest, MutantsOfThePackagesArms) {
  DescriptionOptions options;
  options.base = "base_link";
  options.tip = "tool_tip";
  expectSurvival(readText(ownUrdf("two_link")), options, 2000);
  expectSurvival(readText(ownUrdf("two_link")), {}, 1000);
  expectSurvival(readText(ownUrdf("demo_arm")), options, 500);
}

TEST(UrdfHostileTest, MutantsOfArmsThatPeopleOwn) {
  if (realArmFolder().empty()) GTEST_SKIP() << "set DEMO_LOGGER_URDF to a folder of arms";
  for (const RealArm& arm : realArms()) {
    DescriptionOptions options;
    options.base = arm.base;
    options.tip = arm.tip;
    expectSurvival(readText(realArmPath(arm)), options, 60);
  }
}

}  // namespace
}  // namespace demo_logger
