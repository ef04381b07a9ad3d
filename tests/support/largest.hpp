#pragma once

#include "cases/case/solution.hpp"

#include <cmath>
#include <stdexcept>
#include <vector>

using namespace springproof;

/// The larger of two numbers, and NaN if one is. (std::max drops a NaN, and with it the failure.)
inline double larger(double a, double b) {
  return std::isnan(a) || a > b ? a : b;
}

/// Largest absolute entry, and NaN if one is. (Eigen's maxCoeff() may drop it.)
template<class Derived>
double largest_entry(const Eigen::MatrixBase<Derived>& matrix) {
  return matrix.cwiseAbs().template maxCoeff<Eigen::PropagateNaN>();
}

/// Largest norm of the differences of two lists as long as each other; NaN if a number is.
template<class Value, class Norm>
double largest_difference(const std::vector<Value>& a, const std::vector<Value>& b, const Norm& norm) {
  if (a.empty() || a.size() != b.size()) throw std::invalid_argument("not of one body, or of none");
  double largest = 0;
  for (std::size_t n = 0; n < a.size(); ++n) largest = larger(largest, norm(a[n] - b[n]));
  return largest;
}

/// Largest difference of two displacements of one body, mm; NaN if a number is.
inline double largest_difference(const cases::Solution& a, const cases::Solution& b) {
  return largest_difference(a.displacement, b.displacement, [](const auto& u) { return u.norm(); });
}

/// Largest difference of a cell's volume in two solutions of one body, mm³; NaN if a number is.
inline double largest_volume_difference(const cases::Solution& a, const cases::Solution& b) {
  return largest_difference(a.cell_volume, b.cell_volume, [](double v) { return std::abs(v); });
}
