#include "msm/grid/held_factor.hpp"

#include "msm/direct/factorisation.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace springproof::msm::grid {

using cases::index;

HeldFactor::HeldFactor(const Body& body, const NodeVectors& vectors)
    : body_(body), size_(vectors.size()), number_(index(3 * body.layout.size), -1) {
  for_each_place(body.layout.nodes, [&](int i, int j, int k) {
    for (int c = 0; c < 3; ++c) {
      const std::ptrdiff_t entry = body.layout.at(i, j, k, c);
      if (std::binary_search(body.constrained.begin(), body.constrained.end(), entry)) continue;
      number_[index(entry)] = static_cast<int>(entries_.size());
      entries_.push_back(vectors.entry(entry));
    }
  });
}

/// Moves every third node along each axis at once: a node is coupled only with the nodes of its cells.
Tangent::Matrix HeldFactor::matrix_of(const Operator& apply) const {
  const Layout& layout = body_.layout;
  std::vector<Eigen::Triplet<double>> lower;
  Field<double> moved = Field<double>::Zero(size_), product = moved;
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
    for_each_moved([&](int, int, int, int column) { moved[entries_[index(column)]] = 1; });
    apply(moved, product);
    for_each_moved([&](int i, int j, int k, int column) {
      for (int z = std::max(0, k - 1); z < std::min(layout.nodes[2], k + 2); ++z)
        for (int y = std::max(0, j - 1); y < std::min(layout.nodes[1], j + 2); ++y)
          for (int x = std::max(0, i - 1); x < std::min(layout.nodes[0], i + 2); ++x)
            for (int d = 0; d < 3; ++d) {
              const int row = number_[index(layout.at(x, y, z, d))];
              if (row < column) continue;
              const double coupling = product[entries_[index(row)]];
              if (coupling != 0) lower.emplace_back(row, column, coupling);
            }
    });
  }
  const auto n = static_cast<Eigen::Index>(entries_.size());
  Tangent::Matrix matrix(n, n);
  matrix.setFromTriplets(lower.begin(), lower.end());
  return matrix;
}

/// Appends panels of rows, each column in steps of its own.
void HeldFactor::append(const Eigen::MatrixXd& kept) {
  for (Eigen::Index j = 0; j < kept.cols(); ++j) // columns hold an inverse: none is 0
    steps_.push_back(
        static_cast<float>(kept.col(j).cwiseAbs().maxCoeff() / std::numeric_limits<std::int16_t>::max()));
  const float* const step = steps_.data() + steps_.size() - kept.cols();
  for (Eigen::Index first = 0; first < kept.rows(); first += panel_rows)
    for (Eigen::Index j = 0; j < kept.cols(); ++j)
      for (Eigen::Index r = first; r < std::min<Eigen::Index>(first + panel_rows, kept.rows()); ++r)
        values_.push_back(static_cast<std::int16_t>(std::lround(kept(r, j) / static_cast<double>(step[j]))));
  while (values_.size() % panel_rows != 0) values_.push_back(0);
}

bool HeldFactor::factorise(const Operator& apply) {
  const OneThread one;
  Factorisation factorisation;
  const Tangent::Matrix matrix = matrix_of(apply);
  factorisation.analyse(matrix);
  if (!factorisation.factorise(matrix, 0)) return false;
  ordered_entries_.clear();
  for (const int unknown : factorisation.permutation()) ordered_entries_.push_back(entries_[index(unknown)]);
  blocks_.clear();
  rows_.clear();
  values_.clear();
  steps_.clear();
  factorisation.for_each_block([&](int first, const auto& columns, const int* rows) {
    const int m = static_cast<int>(columns.cols()), below = static_cast<int>(columns.rows()) - m;
    rows_.insert(rows_.end(), rows + m, rows + m + below);
    Eigen::MatrixXd kept = Eigen::MatrixXd::Zero(padded(m + below), m);
    kept.topRows(m).setIdentity();
    columns.topRows(m).template triangularView<Eigen::Lower>().solveInPlace(kept.topRows(m));
    kept.middleRows(m, below) = columns.bottomRows(below) * kept.topRows(m);
    double to_size = 1;
    if (const double largest = below > 0 ? kept.middleRows(m, below).cwiseAbs().maxCoeff() : 0; largest > 0)
      to_size = kept.topRows(m).cwiseAbs().maxCoeff() / largest;
    kept.middleRows(m, below) *= to_size;
    blocks_.push_back({first, m, below, nullptr, nullptr, nullptr, static_cast<float>(1 / to_size)});
    append(kept);
  });
  steps_.resize(steps_.size() + 15);
  const int* row = rows_.data();
  const std::int16_t* value = values_.data();
  const float* step = steps_.data();
  int most = 0;
  for (FactorBlock& block : blocks_) {
    block.rows = row;
    block.values = value;
    block.steps = step;
    row += block.n_below;
    value += block.n_values();
    step += block.n_columns;
    most = std::max(most, block.n_scratch());
  }
  solution_.resize(entries_.size() + 15);
  scratch_.resize(index(most));
  return true;
}

void HeldFactor::apply(const Field<double>& right_side, Field<double>& solution) {
  const double size = norm(body_, right_side, 1);
  if (solution.size() != right_side.size()) solution.setZero(right_side.size());
  const double to_one = size > 0 ? 1 / size : 0;
  for (std::size_t u = 0; u < ordered_entries_.size(); ++u)
    solution_[u] = static_cast<float>(to_one * right_side[ordered_entries_[u]]);
  kernel_set().substitute({blocks_.data(), static_cast<int>(blocks_.size())}, solution_.data(),
                          scratch_.data());
  for (std::size_t u = 0; u < ordered_entries_.size(); ++u)
    solution[ordered_entries_[u]] = size * static_cast<double>(solution_[u]);
}

} // namespace springproof::msm::grid
