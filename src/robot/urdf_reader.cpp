#include "urdf_reader.h"

#include <console_bridge/console.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <optional>
#include <set>
#include <vector>

#include "demo_logger/trajectory/error.h"
#include "near_names.h"
#include "xml_tags.h"

namespace demo_logger {
namespace {

/// While it lives, collects what urdfdom would print to the console. The console is one per process: one at a time.
class CaughtConsole : public console_bridge::OutputHandler {
 public:
  CaughtConsole() : turn_(mutex()), previous_(console_bridge::getOutputHandler()) {
    console_bridge::useOutputHandler(this);
  }
  ~CaughtConsole() override { console_bridge::useOutputHandler(previous_); }
  CaughtConsole(const CaughtConsole&) = delete;
  CaughtConsole& operator=(const CaughtConsole&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char* /*file*/, int /*line*/) override {
    if (level == console_bridge::CONSOLE_BRIDGE_LOG_ERROR) errors_.push_back(text);
  }

  /// The first error and where it was met; urdfdom repeats it at every level above.
  std::string summary() const {
    std::string text;
    for (std::size_t i = 0; i < errors_.size() && i < 2; ++i) {
      if (i == 1 && errors_[i].find("is not initialized correctly") != std::string::npos) break;
      text += (i == 0 ? "" : "; ") + errors_[i];
    }
    return text;
  }

  /// urdfdom gives the reason first, then the link.
  std::map<std::string, std::string> unreadInertia() const {
    const std::string begin = "Could not parse inertial element for Link [";
    std::map<std::string, std::string> reasons;
    for (std::size_t i = 1; i < errors_.size(); ++i) {
      if (errors_[i].compare(0, begin.size(), begin) != 0) continue;
      reasons[errors_[i].substr(begin.size(), errors_[i].size() - begin.size() - 1)] = errors_[i - 1];
    }
    return reasons;
  }

 private:
  static std::mutex& mutex() {
    static std::mutex instance;
    return instance;
  }

  std::lock_guard<std::mutex> turn_;
  console_bridge::OutputHandler* previous_;
  std::vector<std::string> errors_;
};

/// urdfdom accepts a link with two parents, and keeps links that form a loop beside the tree, out of the root's reach.
void refuseWhatIsNoTree(const urdf::ModelInterface& model) {
  std::set<std::string> reached;
  std::vector<urdf::LinkConstSharedPtr> waiting{model.getRoot()};
  while (!waiting.empty()) {
    const urdf::LinkConstSharedPtr link = waiting.back();
    waiting.pop_back();
    if (!reached.insert(link->name).second) {
      throw ModelError("link '" + link->name + "' is the child of two joints; a URDF must be a tree");
    }
    waiting.insert(waiting.end(), link->child_links.begin(), link->child_links.end());
  }
  std::vector<std::string> lost;
  for (const auto& [name, link] : model.links_) {
    if (reached.count(name) == 0) lost.push_back(name);
  }
  if (!lost.empty()) {
    throw ModelError("links " + quotedList(lost) + " form a loop that does not hang from the root link '" +
                     model.getRoot()->name + "'; a URDF must be a tree");
  }
}

/// Elements whose attributes make the robot: what a macro has left in them would be read as a name or a number.
bool makesTheRobot(const std::string& element) {
  static const std::set<std::string> elements = {
      "robot", "link",    "joint",    "parent",           "child", "mimic", "origin", "axis", "limit",
      "mass",  "inertia", "dynamics", "safety_controller"};
  return elements.count(element) != 0;
}

/// What neither urdfdom nor its XML parser survives, and what they would take for something else.
void refuseWhatIsNoUrdf(const std::string& xml) {
  constexpr int kDeepest = 100;     // the XML parser calls itself for each level
  constexpr int kMostLinks = 5000;  // as urdfdom does for each link when it frees a chain of them
  const std::size_t declaration = xml.find("<!DOCTYPE");
  if (declaration < xml.find("<robot") && xml[std::min(xml.find_first_of("[>", declaration), xml.size() - 1)] == '[') {
    throw ModelError(
        "the URDF declares entities in its <!DOCTYPE [...]>, which readers of URDF do not know; remove the "
        "declaration and write out what it stands for");
  }
  int depth = 0, links = 0;
  XmlTags tags(xml);
  while (const std::optional<XmlTag> tag = tags.next()) {
    if (tag->kind == XmlTag::Kind::closing) {
      depth = std::max(depth - 1, 0);
      continue;
    }
    if (tag->kind == XmlTag::Kind::opening && ++depth > kDeepest) {
      throw ModelError("not a valid URDF: elements are nested more than " + std::to_string(kDeepest) + " deep, at <" +
                       tag->name + ">");
    }
    if (tag->name == "link" && ++links > kMostLinks) {
      throw ModelError("the URDF has more than " + std::to_string(kMostLinks) + " links, expected one robot");
    }
    if (tag->name.compare(0, 6, "xacro:") == 0) {
      throw ModelError("this is a xacro file, not a URDF; expand it first: xacro FILE > robot.urdf");
    }
    const bool macro =
        tag->attributes.find("${") != std::string::npos || tag->attributes.find("$(") != std::string::npos;
    if (macro && makesTheRobot(tag->name)) {
      throw ModelError("the URDF still holds a macro, <" + tag->name + tag->attributes +
                       ">; expand the xacro file that it comes from: xacro FILE > robot.urdf");
    }
  }
}

/// urdfdom's words for a joint without <limit> do not say what to do about it.
std::string saidClearly(const std::string& text) {
  const std::string begin = "Joint [";
  for (const auto& [end, type, unit, else_] :
       {std::array<std::string, 4>{"] is of type REVOLUTE but it does not specify limits", "revolute", "rad",
                                   "; if it turns without end, its type is continuous"},
        std::array<std::string, 4>{"] is of type PRISMATIC without limits", "prismatic", "m", ""}}) {
    const std::size_t at = text.find(end);
    if (text.compare(0, begin.size(), begin) != 0 || at == std::string::npos) continue;
    return "joint '" + text.substr(begin.size(), at - begin.size()) + "' is " + type +
           " and has no <limit>, expected one with lower and upper [" + unit + "], velocity and effort" + else_;
  }
  return "not a valid URDF: " + text;
}

/// Links own their children. Before they are freed each must let go of its own: a loop of them would own itself for
/// ever, and a long chain would be freed by as many calls within calls.
urdf::ModelInterfaceSharedPtr freedLinkByLink(const urdf::ModelInterfaceSharedPtr& model) {
  return {model.get(), [model](urdf::ModelInterface* dying) {
            for (const auto& [name, link] : dying->links_) link->child_links.clear();
          }};
}

}  // namespace

ParsedUrdf parseUrdf(const std::string& xml) {
  if (xml.find_first_not_of(" \t\r\n") == std::string::npos) throw ModelError("the URDF text is empty");
  refuseWhatIsNoUrdf(xml);
  ParsedUrdf parsed;
  {
    const CaughtConsole console;
    std::string thrown;
    try {
      parsed.model = urdf::parseURDF(xml);
    } catch (const std::exception& error) {  // urdfdom lets some conversions throw
      thrown = error.what();
    }
    if (!parsed.model) throw ModelError(saidClearly(thrown.empty() ? console.summary() : thrown));
    parsed.model = freedLinkByLink(parsed.model);
    parsed.unread_inertia = console.unreadInertia();
  }
  refuseWhatIsNoTree(*parsed.model);
  return parsed;
}

}  // namespace demo_logger
