#pragma once

#include "cases/case/solution.hpp"
#include "cases/mesh/sharing.hpp"
#include "mechanics/larger.hpp"

#include <cmath>
#include <stdexcept>
#include <vector>

using namespace springproof;

using springproof::mechanics::larger;

/// Largest absolute entry, and NaN if one is. (Eigen's maxCoeff() may drop it.)
template<class Derived>
double largest_entry(const Eigen::MatrixBase<Derived>& matrix) {
  return matrix.cwiseAbs().template maxCoeff<Eigen::PropagateNaN>();
}

/// Largest norm of the differences between a list and a part of it, b, which begins at `first`; NaN if a
/// number is.
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

/// Range of the nodes and cells of a shared solution that are here; empty if nothing is shared.
inline cases::Share part_of(const cases::Solution& alone, const cases::Solution& shared) {
  if (shared.sharing) return shared.sharing->here();
  if (alone.displacement.size() != shared.displacement.size() ||
      alone.cell_volume.size() != shared.cell_volume.size())
    throw std::invalid_argument("not of one body");
  return {};
}

/// Largest displacement of what is here, mm; NaN if a number is.
inline double largest_displacement(const cases::Solution& of) {
  double largest = 0;
  for (const Eigen::Vector3d& u : of.displacement) largest = larger(largest, u.norm());
  return largest;
}

/// Largest difference of two displacements of one body, mm; NaN if a number is.
/// @param b  if ranks share it, the nodes that are here are compared
inline double largest_difference(const cases::Solution& a, const cases::Solution& b) {
  return largest_difference(a.displacement, b.displacement, part_of(a, b).nodes.begin,
                            [](const auto& u) { return u.norm(); });
}

/// Largest difference of a field's values over the field's largest, of the worst field; NaN if a number is,
/// and where a field is zero.
/// @param here  b's part of the body, where ranks share it (part_of()); a has the whole body
inline double largest_difference(const cases::Fields& a, const cases::Fields& b,
                                 const cases::Share& here = {}) {
  double worst = 0;
  const auto compare = [&](const auto& whole, const auto& part, std::size_t first) {
    using Value = std::decay_t<decltype(whole.front())>;
    const bool is_all = first > 0 || part.size() == whole.size() || here.nodes.size() > 0;
    if (part.empty() || first + part.size() > whole.size() || !is_all)
      throw std::invalid_argument("not of one body, or of none");
    constexpr std::size_t n = sizeof(Value) / sizeof(double);
    const auto numbers = [](const auto& values) { return reinterpret_cast<const double*>(values.data()); };
    double largest = 0, difference = 0;
    for (std::size_t i = 0; i < n * whole.size(); ++i) largest = larger(largest, std::abs(numbers(whole)[i]));
    for (std::size_t i = 0; i < n * part.size(); ++i)
      difference = larger(difference, std::abs(numbers(whole)[n * first + i] - numbers(part)[i]));
    worst = larger(worst, difference / largest);
  };
  compare(a.reaction, b.reaction, here.nodes.begin);
  compare(a.strain_energy, b.strain_energy, here.cells.begin);
  compare(a.stress, b.stress, here.cells.begin);
  compare(a.strain, b.strain, here.cells.begin);
  return larger(worst, std::abs(a.total_energy - b.total_energy) / std::abs(a.total_energy));
}

/// Largest difference of a cell's volume in two solutions of one body, mm³; NaN if a number is.
/// @param b  if ranks share it, the cells that are here are compared
inline double largest_volume_difference(const cases::Solution& a, const cases::Solution& b) {
  return largest_difference(a.cell_volume, b.cell_volume, part_of(a, b).cells.begin,
                            [](double v) { return std::abs(v); });
}
