#pragma once

#include <Eigen/Core>
#include <vector>

namespace springproof::compare {

/// Coordinates one after the other, in whole numbers of a unit.
struct Lengths {
  double unit_mm = 1;
  std::vector<long> values;
  bool operator==(const Lengths& other) const { return unit_mm == other.unit_mm && values == other.values; }
};

/// Points in the power of ten that leaves the largest coordinate five digits; 1 mm where all are 0.
Lengths lengths(const std::vector<Eigen::Vector3d>& points);

} // namespace springproof::compare
