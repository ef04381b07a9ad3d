#include "msm/grid/held_factor.hpp"

#include "msm/direct/factorisation.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace springproof::msm::grid {

using cases::index;

HeldFactor::HeldFactor(const Body& body) : body_(body), number_(index(3 * body.layout.size), -1) {
  for_each_place(body.layout.nodes, [&](int i, int j, int k) {
    for (int c = 0; c < 3; ++c) {
      const std::ptrdiff_t entry = body.layout.at(i, j, k, c);
      if (std::binary_search(body.constrained.begin(), body.constrained.end(), entry)) continue;
      number_[index(entry)] = static_cast<int>(entries_.size());
      entries_.push_back(entry);
    }
  });
}

/// A node meets those of its cells alone: every third node along each axis can be moved at once.
Tangent::Matrix HeldFactor::matrix_of(const Operator& apply) const {
  const Layout& layout = body_.layout;
  std::vector<Eigen::Triplet<double>> lower;
  Field<double> moved = Field<double>::Zero(3 * layout.size), product = moved;
  for (int colour = 0; colour < 81; ++colour) {
    const int first[3] = {colour % 3, colour / 3 % 3, colour / 9 % 3}, c = colour / 27;
    const auto for_each_moved = [&](const auto& action) {
      for (int k = first[2]; k < layout.nodes[2]; k += 3)
        for (int j = first[1]; j < layout.nodes[1]; j += 3)
          for (int i = first[0]; i < layout.nodes[0]; i += 3)
            if (const int column = number_[index(layout.at(i, j, k, c))]; column >= 0)
              action(i, j, k, column);
    };
    moved.setZero();
    for_each_moved([&](int i, int j, int k, int) { moved[layout.at(i, j, k, c)] = 1; });
    apply(moved, product);
    for_each_moved([&](int i, int j, int k, int column) {
      for (int z = std::max(0, k - 1); z < std::min(layout.nodes[2], k + 2); ++z)
        for (int y = std::max(0, j - 1); y < std::min(layout.nodes[1], j + 2); ++y)
          for (int x = std::max(0, i - 1); x < std::min(layout.nodes[0], i + 2); ++x)
            for (int d = 0; d < 3; ++d) {
              const std::ptrdiff_t entry = layout.at(x, y, z, d);
              if (const int row = number_[index(entry)]; row >= column && product[entry] != 0)
                lower.emplace_back(row, column, product[entry]);
            }
    });
  }
  const auto n = static_cast<Eigen::Index>(entries_.size());
  Tangent::Matrix matrix(n, n);
  matrix.setFromTriplets(lower.begin(), lower.end());
  return matrix;
}

bool HeldFactor::factorise(const Operator& apply) {
  const OneThread one;
  Factorisation factorisation;
  const Tangent::Matrix matrix = matrix_of(apply);
  factorisation.analyse(matrix);
  if (!factorisation.factorise(matrix, 0)) return false;
  std::vector<std::ptrdiff_t> ordered;
  for (const int unknown : factorisation.permutation()) ordered.push_back(entries_[index(unknown)]);
  blocks_.clear();
  rows_.clear();
  values_.clear();
  int most = 0;
  factorisation.for_each_block([&](int first, const auto& columns, const int* rows) {
    const int m = static_cast<int>(columns.cols()), below = static_cast<int>(columns.rows()) - m;
    blocks_.push_back({first, m, below, nullptr, nullptr});
    rows_.insert(rows_.end(), rows + m, rows + m + below);
    Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(m, m);
    columns.topRows(m).template triangularView<Eigen::Lower>().solveInPlace(inverse);
    const auto append = [&](const auto& block) {
      const std::size_t at = values_.size();
      const int ld = padded(static_cast<int>(block.rows()));
      values_.resize(at + index(ld) * index(m));
      for (int j = 0; j < m; ++j)
        for (int r = 0; r < block.rows(); ++r)
          values_[at + index(j) * index(ld) + index(r)] = static_cast<float>(block(r, j));
    };
    append(inverse);
    append(columns.bottomRows(below));
    most = std::max(most, padded(m) + padded(below));
  });
  const int* row = rows_.data();
  const float* value = values_.data();
  for (FactorBlock& block : blocks_) {
    block.rows = row;
    block.values = value;
    row += block.n_below;
    value += std::ptrdiff_t{block.n_columns} * (padded(block.n_columns) + padded(block.n_below));
  }
  entries_ = ordered;
  solution_.resize(entries_.size());
  scratch_.resize(index(most));
  return true;
}

void HeldFactor::apply(const Field<double>& right_side, Field<double>& solution) {
  const double size = norm(body_, right_side, 1);
  if (solution.size() != right_side.size()) solution.setZero(right_side.size());
  const double to_one = size > 0 ? 1 / size : 0;
  for (std::size_t u = 0; u < entries_.size(); ++u)
    solution_[u] = static_cast<float>(to_one * right_side[entries_[u]]);
  instruction_set().substitute({blocks_.data(), static_cast<int>(blocks_.size())}, solution_.data(),
                               scratch_.data());
  for (std::size_t u = 0; u < entries_.size(); ++u)
    solution[entries_[u]] = size * static_cast<double>(solution_[u]);
}

} // namespace springproof::msm::grid
