#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "demo_logger/trajectory/column.h"
#include "demo_logger/trajectory/metadata.h"

namespace demo_logger {

/// A demonstration ξ = {(x_t, u_t)}: named columns over strictly increasing times. Missing values are NaN, never zero.
struct Demonstration {
  using Values = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  std::vector<Column> columns;  // without the time
  std::vector<double> time;     // [s] since the first row
  Values values;                // one row per time, one column per `columns`
  Metadata metadata;
};

}  // namespace demo_logger
