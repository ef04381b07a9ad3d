#include "msm/tangent.hpp"

#include <algorithm>
#include <cassert>

namespace springproof::msm {

Tangent::Tangent(const Lattice& lattice, const std::vector<bool>& is_constrained) : lattice_(lattice) {
  assert(is_constrained.size() == 3 * lattice.rest.size());
  for (const bool constrained : is_constrained) free_number_.push_back(constrained ? -1 : n_free_++);

  // Calls action(row, column, whether the lower triangle has it) for the nine entries of every block.
  const auto visit = [&](const auto& action) {
    const auto free = [&](int point, int c) { return free_number_[cases::index(3 * point + c)]; };
    visit_tangent_blocks(lattice_, lattice_.rest, Clamp::yes,
                         [&](int row_point, int column_point, const Eigen::Matrix3d&) {
                           for (int c = 0; c < 3; ++c)
                             for (int r = 0; r < 3; ++r) {
                               const int row = free(row_point, r), column = free(column_point, c);
                               action(row, column, column >= 0 && row >= column);
                             }
                         });
  };
  std::vector<Eigen::Triplet<double>> pattern;
  for (int d = 0; d < n_free_; ++d)
    pattern.emplace_back(d, d, 0.0); // a point without springs shows as a zero pivot
  visit([&](int row, int column, bool is_stored) {
    if (is_stored) pattern.emplace_back(row, column, 0.0);
  });
  matrix_.resize(n_free_, n_free_);
  matrix_.setFromTriplets(pattern.begin(), pattern.end());
  visit([&](int row, int column, bool is_stored) {
    slots_.push_back(is_stored ? static_cast<int>(&matrix_.coeffRef(row, column) - matrix_.valuePtr()) : -1);
  });
}

const Tangent::Matrix& Tangent::assemble(const Points& positions, Clamp clamp) {
  double* values = matrix_.valuePtr();
  std::fill(values, values + matrix_.nonZeros(), 0.0);
  const int* slot = slots_.data();
  visit_tangent_blocks(lattice_, positions, clamp, [&](int, int, const Eigen::Matrix3d& block) {
    for (int entry = 0; entry < 9; ++entry, ++slot)
      if (*slot >= 0) values[*slot] += block.data()[entry];
  });
  return matrix_;
}

} // namespace springproof::msm
