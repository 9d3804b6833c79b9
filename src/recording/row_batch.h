#pragma once

#include <cstddef>
#include <vector>

#include "demo_logger/recording/synchroniser.h"

namespace demo_logger {

/// Rows side by side in two arrays, which keep their memory when cleared: no allocation per row.
class RowBatch {
 public:
  explicit RowBatch(std::size_t columns) : columns_(columns) {}

  /// Values that are missing at the end of row.values become NaN, surplus ones are left out.
  void add(const Row& row);
  void clear();

  std::size_t size() const { return stamps_.size(); }
  Nanoseconds stamp(std::size_t row) const { return stamps_[row]; }
  const double* values(std::size_t row) const { return values_.data() + row * columns_; }
  /// What a row takes in memory.
  std::size_t bytesPerRow() const { return sizeof(Nanoseconds) + columns_ * sizeof(double); }

 private:
  std::size_t columns_;
  std::vector<Nanoseconds> stamps_;
  std::vector<double> values_;
};

}  // namespace demo_logger
