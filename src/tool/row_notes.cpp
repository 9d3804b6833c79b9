#include "src/tool/row_notes.h"

namespace demo_logger {

void RowNotes::add(const std::string& kind, std::size_t line, const std::string& sentence) {
  const auto [note, is_new] = notes_.try_emplace(kind, Note{line, sentence, 0});
  ++note->second.count;
}

std::vector<std::string> RowNotes::sentences() const {
  std::vector<std::string> sentences;
  for (const auto& [kind, note] : notes_) {
    std::string text = file_ + ":" + std::to_string(note.line) + ": " + note.sentence;
    if (note.count == 2) text += " (and 1 row more)";
    if (note.count > 2) text += " (and " + std::to_string(note.count - 1) + " rows more)";
    sentences.push_back(text);
  }
  return sentences;
}

}  // namespace demo_logger
