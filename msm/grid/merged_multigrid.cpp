#include "msm/grid/merged_multigrid.hpp"

#include "cases/mesh/hex_mesh.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace springproof::msm::grid {

namespace {

using cases::index;

constexpr int n_nodes_factorised = 100; ///< a dense factorisation of 300 unknowns takes about 1 ms
constexpr int n_dense_nodes = 600; ///< where cells can be merged no further; of more, the smoother must do

constexpr std::ptrdiff_t nodes_at_once = 512, cells_at_once = 32; ///< pieces that threads share

/// Calls action for the numbers below n.
template<class Action>
void for_each(std::ptrdiff_t n, std::ptrdiff_t at_once, int n_threads, const Action& action) {
  if (n_threads == 1 || n <= at_once) { // a parallel region of one thread allocates
    for (std::ptrdiff_t i = 0; i < n; ++i) action(i);
    return;
  }
#pragma omp parallel for num_threads(n_threads) schedule(static, at_once)
  for (std::ptrdiff_t i = 0; i < n; ++i) action(i);
}
template<class Action>
void for_each_node(std::ptrdiff_t n, int n_threads, const Action& action) {
  for_each(n, nodes_at_once, n_threads, action);
}

} // namespace

MergedMultigrid::MergedMultigrid(const Body& finest, const mechanics::grid::Chebyshev& smoother,
                                 int n_threads)
    : finest_(finest), cell_tangent_(finest), smoother_(smoother), n_threads_(n_threads) {
  const Layout& layout = finest.layout;
  std::vector<bool> is_constrained(index(3 * layout.size));
  for (const std::ptrdiff_t entry : finest.constrained) is_constrained[index(entry)] = true;
  std::vector<int> number(index(layout.size), -1);
  for_each_place(finest.cells, [&](int i, int j, int k) {
    if (finest.cell(i, j, k).is_empty()) return;
    std::array<std::ptrdiff_t, 8> entries;
    bool moves = false;
    for (int v = 0; v < 8; ++v) {
      const std::ptrdiff_t entry = entries[index(v)] =
          layout.at(i + (v & 1), j + ((v >> 1) & 1), k + (v >> 2));
      for (int c = 0; c < 3; ++c) moves = moves || !is_constrained[index(entry + c * layout.size)];
    }
    if (!moves) return;
    cells_.places.push_back({i, j, k});
    cells_.nodes.emplace_back();
    for (int v = 0; v < 8; ++v) {
      int& node = number[index(entries[index(v)])];
      if (node < 0) {
        node = cells_.n_nodes++;
        entry_.push_back(entries[index(v)]);
        n_cells_.push_back(0);
        is_held_.emplace_back();
        for (int c = 0; c < 3; ++c)
          is_held_.back()[index(c)] = is_constrained[index(entry_.back() + c * layout.size)];
      }
      cells_.nodes.back()[index(v)] = node;
      ++n_cells_[index(node)];
    }
  });
  std::array<int, 3> n_cells = finest.cells;
  Eigen::Vector3d spacing = finest.spacing;
  const Cells* finer = &cells_;
  while (finer->n_nodes > n_nodes_factorised || levels_.empty()) {
    const auto factor = coarsening_factor(n_cells, spacing);
    if (!factor) break;
    Level& level = levels_.emplace_back();
    level.merged = merge(*finer, *factor);
    for (std::size_t a = 0; a < 3; ++a) {
      spacing[static_cast<int>(a)] *= (*factor)[a];
      n_cells[a] = (n_cells[a] + (*factor)[a] - 1) / (*factor)[a];
    }
    prepare(level);
    finer = &level.merged.cells;
  }
}

/// What does not depend on the displacement.
void MergedMultigrid::prepare(Level& level) const {
  const Cells& cells = level.merged.cells;
  const auto n = index(cells.n_nodes);
  level.restriction = transposed(level.merged.interpolation, cells.n_nodes);
  level.stiffness.resize(cells.nodes.size());
  std::vector<std::array<int, 2>> pairs;
  pairs.reserve(64 * cells.nodes.size());
  for (const auto& nodes : cells.nodes)
    for (const int row : nodes)
      for (const int column : nodes) pairs.push_back({row, column});
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  level.row.assign(n + 1, 0);
  for (const auto& [row, column] : pairs) {
    ++level.row[index(row) + 1];
    level.column.push_back(column);
  }
  for (std::size_t row = 0; row < n; ++row) level.row[row + 1] += level.row[row];
  for (const auto& nodes : cells.nodes) {
    auto& blocks = level.blocks_of_cell.emplace_back();
    for (std::size_t a = 0; a < 8; ++a) {
      const auto begin = level.column.begin() + level.row[index(nodes[a])],
                 end = level.column.begin() + level.row[index(nodes[a]) + 1];
      for (std::size_t b = 0; b < 8; ++b)
        blocks[8 * a + b] = static_cast<int>(std::lower_bound(begin, end, nodes[b]) - level.column.begin());
    }
  }
  level.matrix.resize(pairs.size());
  level.inverse_diagonal.resize(n);
  for (Nodes* nodes : {&level.solution, &level.residual, &level.correction, &level.product})
    nodes->setZero(4, cells.n_nodes);
  SplitMix generator{1};
  std::uniform_real_distribution<float> any(-1, 1);
  level.rough.setZero(4, cells.n_nodes);
  for (Eigen::Index node = 0; node < cells.n_nodes; ++node)
    for (int c = 0; c < 3; ++c) level.rough(c, node) = any(generator);
}

/// The clamped tangent of a cell of the finest body.
CellMatrix MergedMultigrid::stiffness_of(std::size_t cell, const Field<float>& displacement) const {
  const auto& [i, j, k] = cells_.places[cell];
  CellPositions moved;
  for (int v = 0; v < 8; ++v)
    for (int c = 0; c < 3; ++c)
      moved[index(v)][c] = static_cast<double>(
          displacement[entry_[index(cells_.nodes[cell][index(v)])] + c * finest_.layout.size]);
  return cell_tangent_.at(finest_.cell(i, j, k), moved);
}

/// A node's share of what is added to the diagonal.
void MergedMultigrid::add_diagonal(std::size_t cell, const Field<float>& added, CellMatrix& to) const {
  for (int v = 0; v < 8; ++v) {
    const std::size_t node = index(cells_.nodes[cell][index(v)]);
    for (int c = 0; c < 3; ++c)
      to[index(c)](v, v) +=
          added[entry_[node] + c * finest_.layout.size] / static_cast<float>(n_cells_[node]);
  }
}

/// Of a level's cells, from those of the finer level: its cells' stiffness between the coarse corners.
template<class OfFiner>
void MergedMultigrid::gather_stiffness(Level& level, const OfFiner& of_finer, bool is_finest) {
  std::array<Corners, 8> weights; // by where a finer cell begins: finer corners by coarse ones
  for (int begin = 0; begin < 8; ++begin)
    for (int v = 0; v < 8; ++v)
      for (int corner = 0; corner < 8; ++corner)
        weights[index(begin)](v, corner) = static_cast<float>(
            weight_at({begin & 1, (begin >> 1) & 1, begin >> 2}, level.merged.factor, v, corner));
  const auto add = [&](std::size_t cell, CellMatrix& coarse) {
    const std::array<int, 3>& begin = level.merged.begins_at[cell];
    const Corners& all = weights[index(begin[0] + 2 * begin[1] + 4 * begin[2])];
    std::array<Corners, 3> moved{all, all, all}; // what the corners' components are moved by
    if (is_finest)
      for (int v = 0; v < 8; ++v)
        for (std::size_t c = 0; c < 3; ++c)
          if (is_held_[index(cells_.nodes[cell][index(v)])][c]) moved[c].row(v).setZero();
    const CellMatrix finer = of_finer(cell);
    for (std::size_t p = 0; p < n_pairs; ++p) {
      const Corners half = finer[p].lazyProduct(moved[index(second_of_pair[p])]);
      coarse[p] += moved[index(first_of_pair[p])].transpose().lazyProduct(half);
    }
  };
  const auto n_coarse = static_cast<std::ptrdiff_t>(level.stiffness.size());
  for_each(n_coarse, cells_at_once, n_threads_, [&](std::ptrdiff_t at) {
    CellMatrix& coarse = level.stiffness[index(at)];
    for (Corners& pair : coarse) pair.setZero();
    for (int f = level.merged.first_finer[index(at)]; f < level.merged.first_finer[index(at) + 1]; ++f)
      add(index(level.merged.finer_cells[index(f)]), coarse);
  });
}

void MergedMultigrid::assemble(Level& level) const {
  for (Block& block : level.matrix)
    for (Eigen::Vector4f& column : block) column.setZero();
  for (std::size_t cell = 0; cell < level.stiffness.size(); ++cell) {
    const CellMatrix& of = level.stiffness[cell];
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < 8; ++b) {
        Block& block = level.matrix[index(level.blocks_of_cell[cell][index(8 * a + b)])];
        for (std::size_t p = 0; p < n_pairs; ++p) {
          const int r = first_of_pair[p], c = second_of_pair[p];
          block[index(c)][r] += of[p](a, b);
          if (r != c) block[index(r)][c] += of[p](b, a);
        }
      }
  }
}

void MergedMultigrid::invert_diagonal(Level& level) const {
  for (int node = 0; node < level.merged.cells.n_nodes; ++node) {
    const auto begin = level.column.begin() + level.row[index(node)];
    const auto at = index(std::lower_bound(begin, level.column.begin() + level.row[index(node) + 1], node) -
                          level.column.begin());
    Eigen::Matrix3d block;
    bool moves[3];
    for (int c = 0; c < 3; ++c) block.col(c) = level.matrix[at][index(c)].head<3>().cast<double>();
    for (int c = 0; c < 3; ++c) {
      moves[c] = block(c, c) > 0;
      if (moves[c]) continue;
      block.row(c).setZero();
      block.col(c).setZero();
      block(c, c) = 1;
    }
    Eigen::Matrix3d inverse = block.inverse();
    // A node that hangs on too few springs has a singular block: its diagonal must do.
    if (!(block.determinant() > 1e-6 * block.diagonal().prod()))
      inverse = block.diagonal().cwiseInverse().asDiagonal();
    for (int c = 0; c < 3; ++c) {
      if (!moves[c]) inverse(c, c) = 0;
      level.inverse_diagonal[index(node)][index(c)].setZero();
      level.inverse_diagonal[index(node)][index(c)].head<3>() = inverse.col(c).cast<float>();
    }
  }
}

void MergedMultigrid::estimate_largest_eigenvalue(Level& level) const {
  const int n_steps = level.largest_eigenvalue > 0 ? 2 : 12;
  for (int step = 0; step < n_steps; ++step) {
    const float length = level.rough.norm();
    if (!(length > 0)) return; // nothing moves
    multiply(level, level.rough, level.product);
    for_each_node(level.rough.cols(), n_threads_, [&](std::ptrdiff_t node) {
      const Block& inverse = level.inverse_diagonal[index(node)];
      const Eigen::Vector4f r = level.product.col(node) / length;
      level.rough.col(node) = inverse[0] * r[0] + inverse[1] * r[1] + inverse[2] * r[2];
    });
    level.largest_eigenvalue = static_cast<double>(level.rough.norm());
  }
}

bool MergedMultigrid::ends_exactly() const {
  return levels_.back().merged.cells.n_nodes <= n_dense_nodes;
}

void MergedMultigrid::factorise_coarsest() {
  const Level& level = levels_.back();
  coarsest_unknowns_.clear();
  std::vector<Eigen::Index>& number = coarsest_number_;
  number.assign(index(3 * level.merged.cells.n_nodes), -1);
  for (int node = 0; node < level.merged.cells.n_nodes; ++node)
    for (int c = 0; c < 3; ++c)
      if (level.inverse_diagonal[index(node)][index(c)][c] > 0) {
        number[index(3 * node + c)] = static_cast<Eigen::Index>(coarsest_unknowns_.size());
        coarsest_unknowns_.push_back(Eigen::Index{4} * node + c);
      }
  const auto n = static_cast<Eigen::Index>(coarsest_unknowns_.size());
  if (n == 0) return;
  Eigen::MatrixXf& matrix = coarsest_matrix_;
  matrix.setZero(n, n);
  for (int node = 0; node < level.merged.cells.n_nodes; ++node)
    for (int b = level.row[index(node)]; b < level.row[index(node) + 1]; ++b)
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) {
          const Eigen::Index row = number[index(3 * node + r)],
                             column = number[index(3 * level.column[index(b)] + c)];
          if (row >= 0 && column >= 0) matrix(row, column) = level.matrix[index(b)][index(c)][r];
        }
  // Single precision leaves the matrix uncertain by about 1e-7 of its diagonal; a preconditioner may be that
  // stiff.
  const float shift = 1e-6f * matrix.diagonal().cwiseAbs().maxCoeff();
  matrix.diagonal().array() += shift;
  coarsest_.compute(matrix);
  for (float more = 10 * shift; coarsest_.info() != Eigen::Success && more < 1e9f * shift; more *= 10) {
    matrix.diagonal().array() += more;
    coarsest_.compute(matrix);
  }
}

void MergedMultigrid::linearise(const Field<float>& displacement, const Field<float>& added) {
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    Level& level = levels_[l];
    if (l == 0)
      gather_stiffness(
          level,
          [&](std::size_t cell) {
            CellMatrix matrix = stiffness_of(cell, displacement);
            if (added.size() > 0) add_diagonal(cell, added, matrix);
            return matrix;
          },
          true);
    else
      gather_stiffness(
          level, [&](std::size_t cell) { return levels_[l - 1].stiffness[cell]; }, false);
    assemble(level);
    invert_diagonal(level);
    estimate_largest_eigenvalue(level);
  }
  if (!levels_.empty() && ends_exactly()) factorise_coarsest();
}

void MergedMultigrid::multiply(const Level& level, const Nodes& direction, Nodes& product) const {
  for_each_node(product.cols(), n_threads_, [&](std::ptrdiff_t node) {
    Eigen::Vector4f sum = Eigen::Vector4f::Zero();
    for (int b = level.row[index(node)]; b < level.row[index(node) + 1]; ++b) {
      const Block& block = level.matrix[index(b)];
      const float* const at = direction.data() + std::ptrdiff_t{4} * level.column[index(b)];
      sum += block[0] * at[0] + block[1] * at[1] + block[2] * at[2];
    }
    product.col(node) = sum;
  });
}

void MergedMultigrid::add_correction(Level& level, bool keeps_residual) const {
  level.solution += level.correction;
  if (!keeps_residual) return;
  multiply(level, level.correction, level.product);
  level.residual -= level.product;
}

void MergedMultigrid::smooth(Level& level, bool keeps_residual) const {
  const auto precondition = [&](float keep, float factor) {
    for_each_node(level.correction.cols(), n_threads_, [&](std::ptrdiff_t node) {
      const Block& inverse = level.inverse_diagonal[index(node)];
      const float* const at = level.residual.data() + 4 * node;
      level.correction.col(node) = keep * level.correction.col(node) +
                                   factor * (inverse[0] * at[0] + inverse[1] * at[1] + inverse[2] * at[2]);
    });
  };
  mechanics::grid::smooth(
      smoother_, 1.15 * level.largest_eigenvalue, // the power method comes from below
      precondition, [&](bool keeps) { add_correction(level, keeps); }, keeps_residual);
}

/// Solves for the residual of level l; the level's solution is the answer.
void MergedMultigrid::cycle(std::size_t l) {
  Level& level = levels_[l];
  level.solution.setZero();
  if (l + 1 == levels_.size()) {
    if (!ends_exactly()) return smooth(level, false);
    const auto n = static_cast<Eigen::Index>(coarsest_unknowns_.size());
    if (n == 0) return;
    Eigen::VectorXf& answer = coarsest_answer_;
    answer.resize(n);
    for (Eigen::Index u = 0; u < n; ++u) answer[u] = level.residual.data()[coarsest_unknowns_[index(u)]];
    coarsest_.solveInPlace(answer);
    for (Eigen::Index u = 0; u < n; ++u) level.solution.data()[coarsest_unknowns_[index(u)]] = answer[u];
    return;
  }
  if (!(level.largest_eigenvalue > 0)) return; // nothing moves
  smooth(level, true);
  Level& coarser = levels_[l + 1];
  const auto weighted = [&](const Weights& weights, const Nodes& from, Nodes& to) {
    for_each_node(to.cols(), n_threads_, [&](std::ptrdiff_t node) {
      Eigen::Vector4f sum = Eigen::Vector4f::Zero();
      for (int e = weights.start[index(node)]; e < weights.start[index(node) + 1]; ++e)
        sum += weights.entries[index(e)].weight * from.col(weights.entries[index(e)].column);
      to.col(node) = sum;
    });
  };
  weighted(coarser.restriction, level.residual, coarser.residual);
  cycle(l + 1);
  weighted(coarser.merged.interpolation, coarser.solution, level.correction);
  add_correction(level, true);
  smooth(level, false);
}

void MergedMultigrid::correct(const Field<float>& residual, Field<float>& correction) {
  correction.setZero();
  if (levels_.empty()) return;
  Level& level = levels_.front();
  const std::ptrdiff_t size = finest_.layout.size;
  const auto of_row = [](const Weights& weights, std::ptrdiff_t row, const auto& action) {
    for (int e = weights.start[index(row)]; e < weights.start[index(row) + 1]; ++e)
      action(weights.entries[index(e)].column, weights.entries[index(e)].weight);
  };
  for_each_node(level.residual.cols(), n_threads_, [&](std::ptrdiff_t node) {
    Eigen::Vector4f sum = Eigen::Vector4f::Zero(); // a residual is 0 on constrained entries
    of_row(level.restriction, node, [&](int fine, float weight) {
      for (int c = 0; c < 3; ++c) sum[c] += weight * residual[entry_[index(fine)] + c * size];
    });
    level.residual.col(node) = sum;
  });
  cycle(0);
  for_each_node(cells_.n_nodes, n_threads_, [&](std::ptrdiff_t node) {
    Eigen::Vector4f sum = Eigen::Vector4f::Zero();
    of_row(level.merged.interpolation, node,
           [&](int coarse, float weight) { sum += weight * level.solution.col(coarse); });
    for (int c = 0; c < 3; ++c)
      if (!is_held_[index(node)][index(c)]) correction[entry_[index(node)] + c * size] = sum[c];
  });
}

} // namespace springproof::msm::grid
