#include "inbox.h"

#include <utility>

namespace demo_logger {

const Arrival& Message::arrival() const {
  return std::visit([](const auto& one) -> const Arrival& { return one.arrival; }, sample);
}

Inbox::Pushed Inbox::push(Message message) {
  Pushed pushed;
  if (watermark_ && message.received <= *watermark_ - kSetBack) {
    insert(behind_, std::move(message));
  } else {
    if (watermark_ && message.received <= *watermark_) {
      message.received = *watermark_ + 1;
      pushed.late = true;
    }
    insert(messages_, std::move(message));
  }
  if (size() > kCapacity) {
    // Messages that wait for a verdict on the clock go last: they may be the only ones of the new clock.
    Messages& crowded = messages_.empty() ? behind_ : messages_;
    pushed.overflowed = true;
    crowded.erase(crowded.begin());
  }
  return pushed;
}

void Inbox::insert(Messages& messages, Message message) {
  const Key key{message.received, message.source, message.arrival().stamp, ++arrivals_};
  messages.emplace_hint(messages.end(), key, std::move(message));
}

bool Inbox::isSetBack(Nanoseconds watermark) const { return watermark_ && watermark <= *watermark_ - kSetBack; }

void Inbox::restartAt(Nanoseconds watermark) {
  watermark_ = watermark;
  messages_.swap(behind_);
  behind_.clear();
}

std::size_t Inbox::raise(Nanoseconds watermark) {
  const std::size_t very_late = behind_.size();
  for (auto& [key, message] : behind_) {
    message.received = *watermark_ + 1;
    insert(messages_, std::move(message));
  }
  behind_.clear();
  if (!watermark_ || watermark > *watermark_) watermark_ = watermark;
  return very_late;
}

const Message* Inbox::next(bool all) const {
  if (messages_.empty()) return nullptr;
  const Message& first = messages_.begin()->second;
  return all || first.received <= *watermark_ ? &first : nullptr;
}

Message Inbox::take() {
  Message message = std::move(messages_.begin()->second);
  messages_.erase(messages_.begin());
  return message;
}

}  // namespace demo_logger
