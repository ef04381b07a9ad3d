#pragma once

#include "cases/case/solution.hpp"
#include "cases/mesh/sharing.hpp"

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

/// Largest norm of the differences of two lists, the second of which is that part of the first which begins
/// at a place; NaN if a number is.
template<class Value, class Norm>
double largest_difference(const std::vector<Value>& a, const std::vector<Value>& b, std::size_t first,
                          const Norm& norm) {
  if (b.empty() || first + b.size() > a.size()) throw std::invalid_argument("not of one body, or of none");
  double largest = 0;
  for (std::size_t n = 0; n < b.size(); ++n) largest = larger(largest, norm(a[first + n] - b[n]));
  return largest;
}

/// The same of two lists as long as each other.
template<class Value, class Norm>
double largest_difference(const std::vector<Value>& a, const std::vector<Value>& b, const Norm& norm) {
  if (a.size() != b.size()) throw std::invalid_argument("not of one body");
  return largest_difference(a, b, 0, norm);
}

/// What is here of a solution, if all of it is not, among that of one rank alone.
inline cases::Share part_of(const cases::Solution& alone, const cases::Solution& shared) {
  if (shared.sharing) return shared.sharing->here();
  if (alone.displacement.size() != shared.displacement.size() ||
      alone.cell_volume.size() != shared.cell_volume.size())
    throw std::invalid_argument("not of one body");
  return {};
}

/// Largest difference of two displacements of one body, mm; NaN if a number is.
/// @param b  ranks may share it: then of the nodes that are here
inline double largest_difference(const cases::Solution& a, const cases::Solution& b) {
  return largest_difference(a.displacement, b.displacement, part_of(a, b).nodes.begin,
                            [](const auto& u) { return u.norm(); });
}

/// Largest difference of a cell's volume in two solutions of one body, mm³; NaN if a number is.
/// @param b  ranks may share it: then of the cells that are here
inline double largest_volume_difference(const cases::Solution& a, const cases::Solution& b) {
  return largest_difference(a.cell_volume, b.cell_volume, part_of(a, b).cells.begin,
                            [](double v) { return std::abs(v); });
}
