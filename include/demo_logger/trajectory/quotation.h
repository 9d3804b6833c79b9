#pragma once

#include <string>
#include <string_view>

namespace demo_logger {

// Text from elsewhere (a message, a request, a file) in a sentence, a log or a diagnosis, however long or strange it
// is.

/// Its first 80 bytes at most, to the end of a character, and … for the rest; ? for what cannot be printed.
std::string shortened(std::string_view text);

/// The same between double quotes.
std::string inQuotes(std::string_view text);

}  // namespace demo_logger
