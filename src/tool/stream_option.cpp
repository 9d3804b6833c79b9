#include "src/tool/stream_option.h"

#include <locale>
#include <sstream>

#include "demo_logger/trajectory/error.h"

namespace demo_logger {
namespace {

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw ConfigurationError("--stream " + text + ": " + why + ", expected NAME=TOPIC[:hold|linear|nearest[:LATENCY_S]]");
}

/// What stands before the first `separator`; what is behind it stays in `text`.
std::string takeUntil(std::string& text, char separator) {
  const std::size_t end = text.find(separator);
  std::string head = text.substr(0, end);
  text = end == std::string::npos ? std::string() : text.substr(end + 1);
  return head;
}

double parseLatency(const std::string& text, const std::string& latency) {
  std::istringstream stream(latency);
  stream.imbue(std::locale::classic());
  double value = 0.0;
  if (!(stream >> value) || !stream.eof()) {
    refuse(text, "latency \"" + latency + "\" is not a number of seconds");
  }
  return value;
}

}  // namespace

StreamConfiguration parseStreamOption(const std::string& text) {
  if (text.find('=') == std::string::npos) {
    refuse(text, "no =");
  }
  std::string rest = text;
  StreamConfiguration stream;
  stream.name = takeUntil(rest, '=');
  stream.topic = takeUntil(rest, ':');
  if (stream.name.empty() || stream.topic.empty()) {
    refuse(text, stream.name.empty() ? "no name" : "no topic");
  }
  const std::string alignment = takeUntil(rest, ':');
  if (alignment == "linear") {
    stream.alignment = Alignment::linear;
  } else if (alignment == "nearest") {
    stream.alignment = Alignment::nearest;
  } else if (!alignment.empty() && alignment != "hold") {
    refuse(text, "alignment \"" + alignment + "\" is not known");
  }
  if (!rest.empty()) {
    stream.latency = parseLatency(text, rest);
  }
  return stream;
}

}  // namespace demo_logger
