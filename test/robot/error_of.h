#pragma once

#include <functional>
#include <string>

#include "demo_logger/trajectory/error.h"

namespace demo_logger {

/// What an action throws, in its words.
inline std::string errorOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace demo_logger
