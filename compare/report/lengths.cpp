#include "compare/report/lengths.hpp"

#include <algorithm>
#include <cmath>

namespace springproof::compare {

Lengths lengths(const std::vector<Eigen::Vector3d>& points) {
  double largest = 0;
  for (const Eigen::Vector3d& x : points) largest = std::max(largest, x.cwiseAbs().maxCoeff());
  Lengths result;
  if (largest > 0) result.unit_mm = std::pow(10.0, std::floor(std::log10(largest)) - 4);
  for (const Eigen::Vector3d& x : points)
    for (const double coordinate : x) result.values.push_back(std::lround(coordinate / result.unit_mm));
  return result;
}

} // namespace springproof::compare
