#pragma once

#include <cmath>

namespace springproof::mechanics {

/// The larger of two numbers, and NaN if one is. (std::max drops a NaN, and with it the failure.)
inline double larger(double a, double b) {
  return std::isnan(a) || a > b ? a : b;
}

} // namespace springproof::mechanics
