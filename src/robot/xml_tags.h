#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace demo_logger {

/// What stands between < and > of one tag; comments, declarations and character data are passed over.
struct XmlTag {
  enum class Kind { opening, closing, empty } kind = Kind::opening;
  std::string name;
  std::string attributes;  // as written, quotes included
};

/// Walks through the tags of XML text without a parser's recursion: to judge text before a parser sees it. Nothing is
/// verified; at the first thing that is no tag it ends.
class XmlTags {
 public:
  /// `xml` must outlive this.
  explicit XmlTags(const std::string& xml) : xml_(xml) {}

  std::optional<XmlTag> next();

 private:
  bool startsWith(const char* text) const;
  void skipPast(const char* end);
  std::size_t endOfTag() const;

  const std::string& xml_;
  std::size_t position_ = 0;
};

}  // namespace demo_logger
