#pragma once

#include <string>

namespace demo_logger {

/// SHA-256 (FIPS 180-4) of the bytes of `text`, as 64 lower-case hexadecimal digits.
std::string sha256(const std::string& text);

}  // namespace demo_logger
