#pragma once

#include <chrono>
#include <thread>

namespace demo_logger {

/// Waits for something that must come, however slow the machine; gives up after a minute.
template <typename Condition>
bool eventually(Condition condition) {
  for (int attempt = 0; attempt < 60000 && !condition(); ++attempt) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return condition();
}

}  // namespace demo_logger
