#include "xml_tags.h"

#include <algorithm>
#include <cstring>

namespace demo_logger {

std::optional<XmlTag> XmlTags::next() {
  while (true) {
    position_ = xml_.find('<', position_);
    if (position_ == std::string::npos) return std::nullopt;
    if (startsWith("<!--")) {
      skipPast("-->");
    } else if (startsWith("<![CDATA[")) {
      skipPast("]]>");
    } else if (startsWith("<!") || startsWith("<?")) {
      skipPast(">");
    } else {
      break;
    }
  }
  const std::size_t end = endOfTag();
  if (end == std::string::npos) {
    position_ = end;
    return std::nullopt;
  }
  XmlTag tag;
  std::size_t first = position_ + 1, last = end;
  if (xml_[first] == '/') {
    tag.kind = XmlTag::Kind::closing;
    ++first;
  } else if (xml_[end - 1] == '/') {
    tag.kind = XmlTag::Kind::empty;
    --last;
  }
  const std::size_t after_name = std::min(xml_.find_first_of(" \t\r\n/>", first), last);
  tag.name = xml_.substr(first, after_name - first);
  tag.attributes = xml_.substr(after_name, last - after_name);
  position_ = end + 1;
  return tag;
}

bool XmlTags::startsWith(const char* text) const { return xml_.compare(position_, std::strlen(text), text) == 0; }

void XmlTags::skipPast(const char* end) {
  const std::size_t found = xml_.find(end, position_);
  position_ = found == std::string::npos ? xml_.size() : found + std::strlen(end);
}

/// A > within quotes ends nothing.
std::size_t XmlTags::endOfTag() const {
  std::size_t position = position_ + 1;
  while (position < xml_.size()) {
    const char letter = xml_[position];
    if (letter == '>') return position;
    if (letter == '"' || letter == '\'') {
      position = xml_.find(letter, position + 1);
      if (position == std::string::npos) return position;
    }
    ++position;
  }
  return std::string::npos;
}

}  // namespace demo_logger
