#pragma once

#include <Eigen/SparseCore>
#include <algorithm>
#include <cstddef>
#include <vector>

namespace springproof::mechanics {

/// A symmetric sparse matrix on free degrees of freedom that 3x3 blocks of points add up to, such as a
/// tangent stiffness. The pattern, and every block's place in it, are found once.
///
/// Blocks come from a function visit(sink), which calls sink(row point, column point, block) for every block
/// with row point >= column point, always in the same order.
class BlockMatrix {
 public:
  using Matrix = Eigen::SparseMatrix<double>;

  /// @param is_constrained  degree of freedom 3*point + component, three entries per point
  template<class Visit>
  BlockMatrix(const std::vector<bool>& is_constrained, const Visit& visit) {
    for (const bool constrained : is_constrained) free_number_.push_back(constrained ? -1 : n_free_++);
    // Calls action(row, column, whether the lower triangle has it) for the nine entries of every block.
    const auto visit_entries = [&](const auto& action) {
      const auto free = [&](int point, int c) {
        return free_number_[static_cast<std::size_t>(3 * point + c)];
      };
      visit([&](int row_point, int column_point, const Eigen::Matrix3d&) {
        for (int c = 0; c < 3; ++c)
          for (int r = 0; r < 3; ++r) {
            const int row = free(row_point, r), column = free(column_point, c);
            action(row, column, column >= 0 && row >= column);
          }
      });
    };
    std::vector<Eigen::Triplet<double>> pattern;
    for (int d = 0; d < n_free_; ++d)
      pattern.emplace_back(d, d, 0.0); // a point without blocks shows as a zero pivot
    visit_entries([&](int row, int column, bool is_stored) {
      if (is_stored) pattern.emplace_back(row, column, 0.0);
    });
    matrix_.resize(n_free_, n_free_);
    matrix_.setFromTriplets(pattern.begin(), pattern.end());
    visit_entries([&](int row, int column, bool is_stored) {
      slots_.push_back(is_stored ? static_cast<int>(&matrix_.coeffRef(row, column) - matrix_.valuePtr())
                                 : -1);
    });
  }

  /// Lower triangle of the sum.
  template<class Visit>
  const Matrix& assemble(const Visit& visit) {
    double* values = matrix_.valuePtr();
    std::fill(values, values + matrix_.nonZeros(), 0.0);
    const int* slot = slots_.data();
    visit([&](int, int, const Eigen::Matrix3d& block) {
      for (int entry = 0; entry < 9; ++entry, ++slot)
        if (*slot >= 0) values[*slot] += block.data()[entry];
    });
    return matrix_;
  }

  int n_free() const { return n_free_; }
  /// Number among the free ones of degree of freedom 3*point + component, or -1.
  const std::vector<int>& free_number() const { return free_number_; }

 private:
  std::vector<int> free_number_;
  int n_free_ = 0;
  Matrix matrix_;
  std::vector<int> slots_; ///< places among the matrix's values, 9 per block as visited; -1: none
};

} // namespace springproof::mechanics
