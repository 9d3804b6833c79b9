#include "row_batch.h"

#include <algorithm>
#include <limits>

namespace demo_logger {

void RowBatch::add(const Row& row) {
  const std::size_t given = std::min(row.values.size(), columns_);
  stamps_.push_back(row.stamp);
  values_.insert(values_.end(), row.values.begin(), row.values.begin() + static_cast<std::ptrdiff_t>(given));
  values_.resize(stamps_.size() * columns_, std::numeric_limits<double>::quiet_NaN());
}

void RowBatch::clear() {
  stamps_.clear();
  values_.clear();
}

}  // namespace demo_logger
