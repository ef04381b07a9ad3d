#pragma once

#include "cases/case/solution.hpp"

#include <cmath>
#include <stdexcept>

using namespace springproof;

/// The larger of two numbers, and NaN if one is: std::max would drop it, and with it the failure that it
/// shows.
inline double larger(double a, double b) {
  return std::isnan(a) || a > b ? a : b;
}

/// Largest difference of two displacements of one body, mm; NaN if a number is.
inline double largest_difference(const cases::Solution& a, const cases::Solution& b) {
  if (a.displacement.size() != b.displacement.size()) throw std::invalid_argument("not of one body");
  double largest = 0;
  for (std::size_t n = 0; n < a.displacement.size(); ++n)
    largest = larger(largest, (a.displacement[n] - b.displacement[n]).norm());
  return largest;
}
