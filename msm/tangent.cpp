#include "msm/tangent.hpp"

#include "cases/case/index.hpp"

#include <algorithm>
#include <cassert>

namespace springproof::msm {

namespace {

using cases::index;

/// Calls action(row, column, block row, block column) for the nine entries of a block; row = -1: not in the
/// lower triangle of the free degrees of freedom.
template<class Action>
void for_each_entry(const std::vector<int>& free_number, int row_point, int column_point,
                    const Action& action) {
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) {
      const int row = free_number[index(3 * row_point + r)],
                column = free_number[index(3 * column_point + c)];
      const bool stored = row >= 0 && column >= 0 && row >= column;
      action(stored ? row : -1, column, r, c);
    }
}

int find_slot(const Tangent::Matrix& matrix, int row, int column) {
  const int* begin = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column];
  const int* end = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column + 1];
  return static_cast<int>(std::lower_bound(begin, end, row) - matrix.innerIndexPtr());
}

} // namespace

Tangent::Tangent(const Lattice& lattice, const std::vector<bool>& is_constrained) : lattice_(lattice) {
  assert(is_constrained.size() == 3 * lattice.rest.size());
  free_number_.resize(is_constrained.size());
  for (std::size_t d = 0; d < is_constrained.size(); ++d)
    free_number_[d] = is_constrained[d] ? -1 : n_free_++;

  std::vector<Eigen::Triplet<double>> pattern;
  for (int d = 0; d < n_free_; ++d)
    pattern.emplace_back(d, d, 0.0); // a point without springs shows as a zero pivot
  const auto visit = [&](const auto& action) {
    visit_tangent_blocks(lattice_, lattice_.rest, TransverseTerm::clamped,
                         [&](int row_point, int column_point, const Eigen::Matrix3d&) {
                           for_each_entry(free_number_, row_point, column_point, action);
                         });
  };
  visit([&](int row, int column, int, int) {
    if (row >= 0) pattern.emplace_back(row, column, 0.0);
  });
  matrix_.resize(n_free_, n_free_);
  matrix_.setFromTriplets(pattern.begin(), pattern.end());
  visit([&](int row, int column, int, int) {
    slots_.push_back(row < 0 ? -1 : find_slot(matrix_, row, column));
  });
}

const Tangent::Matrix& Tangent::assemble(const Points& positions, TransverseTerm term) {
  double* values = matrix_.valuePtr();
  std::fill(values, values + matrix_.nonZeros(), 0.0);
  const int* slot = slots_.data();
  visit_tangent_blocks(lattice_, positions, term, [&](int, int, const Eigen::Matrix3d& block) {
    for (int entry = 0; entry < 9; ++entry, ++slot)
      if (*slot >= 0) values[*slot] += block.data()[entry];
  });
  return matrix_;
}

} // namespace springproof::msm
