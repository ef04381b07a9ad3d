#include "msm/grid/merged_cells.hpp"

#include "cases/mesh/mesh.hpp"

#include <algorithm>
#include <numeric>

namespace springproof::msm::grid {

namespace {

using cases::index;

int bit(int vertex, std::size_t axis) {
  return (vertex >> axis) & 1;
}

/// Sets of slots that are one (union by the smaller number, paths halved).
class Unions {
 public:
  explicit Unions(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  int root(int slot) {
    while (parent_[index(slot)] != slot) slot = parent_[index(slot)] = parent_[index(parent_[index(slot)])];
    return slot;
  }
  void join(int a, int b) {
    a = root(a), b = root(b);
    parent_[index(std::max(a, b))] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

} // namespace

double weight_at(const std::array<int, 3>& begins_at, const std::array<int, 3>& factor, int finer,
                 int coarse) {
  double weight = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    const double at = static_cast<double>(begins_at[a] + bit(finer, a)) / factor[a];
    weight *= bit(coarse, a) ? at : 1 - at;
  }
  return weight;
}

Weights transposed(const Weights& weights, int n_columns) {
  Weights result;
  result.start.assign(index(n_columns) + 1, 0);
  for (const auto& [column, weight] : weights.entries) ++result.start[index(column) + 1];
  std::partial_sum(result.start.begin(), result.start.end(), result.start.begin());
  result.entries.resize(weights.entries.size());
  std::vector<int> next(result.start.begin(), result.start.end() - 1);
  for (std::size_t row = 0; row + 1 < weights.start.size(); ++row)
    for (int e = weights.start[row]; e < weights.start[row + 1]; ++e) {
      const auto& [column, weight] = weights.entries[index(e)];
      result.entries[index(next[index(column)]++)] = {static_cast<int>(row), weight};
    }
  return result;
}

MergedCells merge(const Cells& finer, const std::array<int, 3>& factor) {
  const std::size_t n = finer.nodes.size();
  MergedCells result;
  result.factor = factor;
  result.begins_at.resize(n);
  std::vector<std::array<int, 3>> places(n);
  for (std::size_t cell = 0; cell < n; ++cell)
    for (std::size_t a = 0; a < 3; ++a) {
      places[cell][a] = finer.places[cell][a] / factor[a];
      result.begins_at[cell][a] = finer.places[cell][a] % factor[a];
    }
  // Every finer cell has eight corners of a coarse one of its own, its slots, which its nodes join.
  Unions corners(8 * n);
  std::vector<std::array<int, 8>> met(index(finer.n_nodes)); // a node's first slots, by the corner's place
  for (auto& slots : met) slots.fill(-1);
  for (std::size_t cell = 0; cell < n; ++cell)
    for (int v = 0; v < 8; ++v)
      for (int corner = 0; corner < 8; ++corner) {
        if (!(weight_at(result.begins_at[cell], factor, v, corner) > 0)) continue;
        int place = 0; // the corner's, against the node's own divided by the factor and rounded down
        for (std::size_t a = 0; a < 3; ++a) {
          const int below = (finer.places[cell][a] + bit(v, a)) / factor[a];
          place |= (places[cell][a] + bit(corner, a) - below) << a;
        }
        int& first = met[index(finer.nodes[cell][index(v)])][index(place)];
        const int slot = static_cast<int>(8 * cell) + corner;
        if (first < 0)
          first = slot;
        else
          corners.join(first, slot);
      }
  std::vector<int> number(8 * n, -1);
  std::vector<std::array<int, 8>> nodes(n);
  for (std::size_t cell = 0; cell < n; ++cell)
    for (int corner = 0; corner < 8; ++corner) {
      int& of_root = number[index(corners.root(static_cast<int>(8 * cell) + corner))];
      if (of_root < 0) of_root = result.cells.n_nodes++;
      nodes[cell][index(corner)] = of_root;
    }
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return nodes[a] < nodes[b]; });
  for (const std::size_t cell : order) {
    if (result.cells.nodes.empty() || result.cells.nodes.back() != nodes[cell]) {
      result.cells.nodes.push_back(nodes[cell]);
      result.cells.places.push_back(places[cell]);
      result.first_finer.push_back(static_cast<int>(result.finer_cells.size()));
    }
    result.finer_cells.push_back(static_cast<int>(cell));
  }
  result.first_finer.push_back(static_cast<int>(n));
  std::vector<std::array<int, 2>> met_by(index(finer.n_nodes), {-1, -1}); // a cell, and which of its nodes
  for (std::size_t cell = 0; cell < n; ++cell)
    for (int v = 0; v < 8; ++v) met_by[index(finer.nodes[cell][index(v)])] = {static_cast<int>(cell), v};
  for (const auto& [cell, v] : met_by) {
    for (int corner = 0; cell >= 0 && corner < 8; ++corner)
      if (const double weight = weight_at(result.begins_at[index(cell)], factor, v, corner); weight > 0)
        result.interpolation.entries.push_back(
            {nodes[index(cell)][index(corner)], static_cast<float>(weight)});
    result.interpolation.start.push_back(static_cast<int>(result.interpolation.entries.size()));
  }
  return result;
}

} // namespace springproof::msm::grid
