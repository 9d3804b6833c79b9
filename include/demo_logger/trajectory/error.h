#pragma once

#include <stdexcept>

namespace demo_logger {

/// The root of everything this project throws. The sentence says where, what value with its unit, what was
/// expected, and what to try; it is shown to the user as it is.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file that cannot be read or written as asked.
class FileError : public Error {
 public:
  using Error::Error;
};

/// A parameter, option or configuration value outside what was expected.
class ConfigurationError : public Error {
 public:
  using Error::Error;
};

/// A robot description that cannot be used as asked.
class ModelError : public Error {
 public:
  using Error::Error;
};

}  // namespace demo_logger
