#pragma once

#include <Eigen/Core>
#include <fmt/format.h>

namespace springproof::cases {

/// For messages about a body that is too small or too large for its cells.
/// @param size  along the axes, mm
inline std::string scale_hint(const Eigen::Vector3d& size) {
  return fmt::format("the file's body is {:.4g} x {:.4g} x {:.4g} mm; where its unit is another, body.scale "
                     "says how many mm that is (1000 for metres)",
                     size.x(), size.y(), size.z());
}

} // namespace springproof::cases
