#pragma once

#include <cstddef>

namespace demo_logger {

/// How often this process has asked for memory, by `new` or by `malloc` (Eigen's way). Include in one file of a test:
/// it replaces malloc. Under a sanitizer, which brings its own, nothing is counted.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kAllocationsAreCounted = false;
inline std::size_t allocations() { return 0; }
#else
constexpr bool kAllocationsAreCounted = true;
inline thread_local std::size_t allocation_count = 0;
inline std::size_t allocations() { return allocation_count; }
#endif

}  // namespace demo_logger

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
extern "C" void* __libc_malloc(std::size_t size);  // NOLINT(bugprone-reserved-identifier): glibc's own

extern "C" void* malloc(std::size_t size) noexcept {
  ++demo_logger::allocation_count;
  return __libc_malloc(size);
}
#endif
