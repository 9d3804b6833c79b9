#pragma once

#include <string>

#include "demo_logger/recording/stream_configuration.h"

namespace demo_logger {

/// NAME=TOPIC[:hold|linear|nearest[:LATENCY_S]], as given to --stream. Throws ConfigurationError.
StreamConfiguration parseStreamOption(const std::string& text);

}  // namespace demo_logger
