#include "demo_logger/trajectory/quotation.h"

#include <algorithm>
#include <cstddef>

namespace demo_logger {
namespace {

constexpr std::size_t kLongest = 80;  // bytes

bool continuesCharacter(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U; }  // of UTF-8

bool isUnprintable(char byte) { return static_cast<unsigned char>(byte) < ' ' || byte == '\x7f'; }

}  // namespace

std::string shortened(std::string_view text) {
  std::size_t end = std::min(text.size(), kLongest);
  while (end < text.size() && end > kLongest - 3 && continuesCharacter(text[end])) --end;
  std::string shown(text.substr(0, end));
  std::replace_if(shown.begin(), shown.end(), isUnprintable, '?');
  return end < text.size() ? shown + "…" : shown;
}

std::string inQuotes(std::string_view text) { return "\"" + shortened(text) + "\""; }

}  // namespace demo_logger
