#pragma once

#include <string>
#include <vector>

#include "demo_logger/trajectory/column.h"

namespace demo_logger {

/// What the names of columns say by themselves (doc/file_format.md): `q_<joint>` is a joint position [rad], a state, to
/// be resampled linearly; `u_vx` a commanded velocity [m/s], a control, in force until replaced; columns beside a
/// `<stream>_age` belong to that stream and stay in force as well. Four consecutive names `…_qx …_qy …_qz …_qw` are an
/// orientation. A name that says nothing is auxiliary, without a unit, not to be interpolated. Every column gets an
/// empty `source`. Joints count as revolute.
std::vector<Column> describeColumns(const std::vector<std::string>& names);

}  // namespace demo_logger
