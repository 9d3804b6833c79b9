#include "urdf_reader.h"

#include <console_bridge/console.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <mutex>
#include <set>
#include <vector>

#include "demo_logger/trajectory/error.h"
#include "near_names.h"

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

/// A xacro element outside comments: urdfdom would skip it, and with it half the robot, without a word.
bool isXacro(const std::string& xml) {
  const std::string begin = "<!--";
  const std::string end = "-->";
  std::size_t position = 0;
  while (true) {
    const std::size_t comment = xml.find(begin, position);
    const std::size_t element = xml.find("<xacro:", position);
    if (element < comment) return true;
    if (comment == std::string::npos) return false;
    position = xml.find(end, comment + begin.size());
    if (position == std::string::npos) return false;
  }
}

}  // namespace

ParsedUrdf parseUrdf(const std::string& xml) {
  if (xml.find_first_not_of(" \t\r\n") == std::string::npos) throw ModelError("the URDF text is empty");
  if (isXacro(xml)) {
    throw ModelError("this is a xacro file, not a URDF; expand it first: xacro FILE > robot.urdf");
  }
  ParsedUrdf parsed;
  {
    const CaughtConsole console;
    std::string thrown;
    try {
      parsed.model = urdf::parseURDF(xml);
    } catch (const std::exception& error) {  // urdfdom lets some conversions throw
      thrown = error.what();
    }
    if (!parsed.model) throw ModelError("not a valid URDF: " + (thrown.empty() ? console.summary() : thrown));
    parsed.unread_inertia = console.unreadInertia();
  }
  try {
    refuseWhatIsNoTree(*parsed.model);
  } catch (const ModelError&) {
    // Links own their children: a loop of them would own itself for ever.
    for (const auto& [name, link] : parsed.model->links_) link->child_links.clear();
    throw;
  }
  return parsed;
}

}  // namespace demo_logger
