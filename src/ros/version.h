#pragma once

namespace demo_logger {

/// What wrote a file: "demo_logger 0.1.0".
constexpr const char* kSoftware = "demo_logger " DEMO_LOGGER_VERSION;

}  // namespace demo_logger
