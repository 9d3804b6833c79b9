#pragma once

#include <atomic>
#include <cstddef>

// Counts every allocation of the program: operator new and Eigen both end in malloc, which this replaces by a counter
// in front of glibc's. Include it in one source file of a test. Sanitizers bring a malloc of their own; then nothing is
// counted, and kAllocationsAreCounted says so.

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
namespace demo_logger {
constexpr bool kAllocationsAreCounted = true;
inline std::atomic<std::size_t> allocation_count{0};
}  // namespace demo_logger

// glibc's own names; the linter would keep the leading underscores for the system.
extern "C" void* __libc_malloc(std::size_t size);  // NOLINT(bugprone-reserved-identifier)
extern "C" void* malloc(std::size_t size) {        // NOLINT(misc-definitions-in-headers)
  ++demo_logger::allocation_count;
  return __libc_malloc(size);
}
#else
namespace demo_logger {
constexpr bool kAllocationsAreCounted = false;
inline std::atomic<std::size_t> allocation_count{0};
}  // namespace demo_logger
#endif
