#include "cases/mesh/mesh.hpp"
#include "mechanics/grid/transfer.hpp"
#include "msm/grid/cell_tangent.hpp"
#include "msm/grid/merged_cells.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace springproof::msm::grid {

namespace {

using cases::index;

constexpr int n_nodes_factorised = 100; ///< a dense factorisation of 300 unknowns takes about 1 ms
constexpr int n_dense_nodes = 600;      ///< most where merging has ended; with more, the smoother must do

constexpr std::ptrdiff_t nodes_at_once = 512, cells_at_once = 32; ///< pieces that threads share

template<class Action>
void for_each_node(std::ptrdiff_t n, int n_threads, const Action& action) {
  mechanics::grid::on_threads(n, n_threads, action, nodes_at_once);
}

/// The finest body's cells, without those that are held as a whole.
struct FinestCells {
  explicit FinestCells(const Body& finest);
  Cells cells{};
  std::vector<std::ptrdiff_t> entry{};        ///< each node's in a field, along x
  std::vector<std::array<bool, 3>> is_held{}; ///< each node's components
  std::vector<int> n_cells{};                 ///< number of cells at each node
};

FinestCells::FinestCells(const Body& finest) {
  const Layout& layout = finest.layout;
  std::vector<bool> is_constrained(index(3 * layout.size));
  for (const std::ptrdiff_t held : finest.constrained) is_constrained[index(held)] = true;
  std::vector<int> number(index(layout.size), -1);
  for_each_place(finest.cells, [&](int i, int j, int k) {
    if (finest.cell(i, j, k).is_empty()) return;
    std::array<std::ptrdiff_t, 8> entries;
    bool moves = false;
    for (int v = 0; v < 8; ++v) {
      const std::ptrdiff_t at = entries[index(v)] = layout.at(i + (v & 1), j + ((v >> 1) & 1), k + (v >> 2));
      for (int c = 0; c < 3; ++c) moves = moves || !is_constrained[index(at + c * layout.size)];
    }
    if (!moves) return;
    cells.places.push_back({i, j, k});
    cells.nodes.emplace_back();
    for (int v = 0; v < 8; ++v) {
      int& node = number[index(entries[index(v)])];
      if (node < 0) {
        node = cells.n_nodes++;
        entry.push_back(entries[index(v)]);
        n_cells.push_back(0);
        is_held.emplace_back();
        for (int c = 0; c < 3; ++c)
          is_held.back()[index(c)] = is_constrained[index(entry.back() + c * layout.size)];
      }
      cells.nodes.back()[index(v)] = node;
      ++n_cells[index(node)];
    }
  });
}

using Nodes = Eigen::Matrix<float, 4, Eigen::Dynamic>; ///< a vector at every node, and 0
using Block = std::array<Eigen::Vector4f, 3>;          ///< columns of a 3x3 matrix, each with a 0

Eigen::Map<Nodes> at_nodes(Field<float>& field) {
  return {field.data(), 4, field.size() / 4};
}
Eigen::Vector4f product(const Block& block, const float* at) {
  return block[0] * at[0] + block[1] * at[1] + block[2] * at[2];
}

/// Calls to(row, sum of weights times from(column)) for all rows.
template<class From, class To>
void for_each_sum(const Weights& weights, int n_threads, const From& from, const To& to) {
  for_each_node(static_cast<std::ptrdiff_t>(weights.start.size()) - 1, n_threads, [&](std::ptrdiff_t row) {
    Eigen::Vector4f sum = Eigen::Vector4f::Zero();
    for (int e = weights.start[index(row)]; e < weights.start[index(row) + 1]; ++e)
      sum += weights.entries[index(e)].weight * from(weights.entries[index(e)].column);
    to(row, sum);
  });
}

/// Merged cells on merged cells.
class MergedLevel : public mechanics::grid::Level {
 public:
  MergedLevel(MergedCells merged, const MergedLevel* finer, int n_threads)
      : Level(std::ptrdiff_t{4} * merged.cells.n_nodes, n_threads), merged_(std::move(merged)),
        restriction_(transposed(merged_.interpolation, merged_.cells.n_nodes)), finer_(finer),
        stiffness_(merged_.cells.nodes.size()), row_(index(merged_.cells.n_nodes) + 1, 0),
        inverse_(index(merged_.cells.n_nodes)) {
    std::vector<std::array<int, 2>> pairs;
    pairs.reserve(64 * cells().nodes.size());
    for (const auto& nodes : cells().nodes)
      for (const int row : nodes)
        for (const int column : nodes) pairs.push_back({row, column});
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    for (const auto& [row, column] : pairs) {
      ++row_[index(row) + 1];
      column_.push_back(column);
    }
    std::partial_sum(row_.begin(), row_.end(), row_.begin());
    for (const auto& nodes : cells().nodes) {
      auto& blocks = blocks_of_cell_.emplace_back();
      for (std::size_t a = 0; a < 8; ++a) {
        const auto begin = column_.begin() + row_[index(nodes[a])],
                   end = column_.begin() + row_[index(nodes[a]) + 1];
        for (std::size_t b = 0; b < 8; ++b)
          blocks[8 * a + b] = static_cast<int>(std::lower_bound(begin, end, nodes[b]) - column_.begin());
      }
    }
    matrix_.resize(pairs.size());
  }
  const Cells& cells() const { return merged_.cells; }

  void linearise() override {
    prepare([&](std::size_t cell) { return finer_->stiffness_[cell]; }, [](std::size_t, auto&) {});
  }
  void multiply(Field<float>& direction, Field<float>& result) const override {
    const float* const from = direction.data();
    auto to = at_nodes(result);
    for_each_node(to.cols(), n_threads_, [&](std::ptrdiff_t node) {
      Eigen::Vector4f sum = Eigen::Vector4f::Zero();
      for (int b = row_[index(node)]; b < row_[index(node) + 1]; ++b)
        sum += product(matrix_[index(b)], from + std::ptrdiff_t{4} * column_[index(b)]);
      to.col(node) = sum;
    });
  }
  void precondition(const Field<float>& in, Field<float>& out, float keep, float factor) const override {
    auto to = at_nodes(out);
    for_each_node(to.cols(), n_threads_, [&](std::ptrdiff_t node) {
      to.col(node) = keep * to.col(node) + factor * product(inverse_[index(node)], in.data() + 4 * node);
    });
  }
  double norm(const Field<float>& field) const override { return static_cast<double>(field.norm()); }
  void set_rough(Field<float>& rough) const override {
    mechanics::grid::SplitMix generator{1};
    std::uniform_real_distribution<float> any(-1, 1);
    for (Eigen::Index entry = 0; entry < rough.size(); ++entry)
      if (entry % 4 < 3) rough[entry] = any(generator);
  }
  bool factorise() override {
    if (cells().n_nodes > n_dense_nodes) return false;
    Eigen::MatrixXf& matrix = factor_.begin(solution_.size(), [&](std::ptrdiff_t entry) {
      const auto c = index(entry % 4);
      return c < 3 && inverse_[index(entry / 4)][c][entry % 4] > 0;
    });
    const std::vector<int>& number = factor_.number;
    for (int node = 0; node < cells().n_nodes; ++node)
      for (int b = row_[index(node)]; b < row_[index(node) + 1]; ++b)
        for (int c = 0; c < 3; ++c)
          for (int r = 0; r < 3; ++r) {
            const int row = number[index(4 * node + r)], column = number[index(4 * column_[index(b)] + c)];
            if (row >= 0 && column >= 0) matrix(row, column) = matrix_[index(b)][index(c)][r];
          }
    factor_.factorise(decltype(factor_)::Indefinite::shift);
    return true;
  }
  void solve_exactly() override { factor_.solve(residual_, solution_); }

  void restrict_from(Field<float>& finer_residual) override {
    const auto from = at_nodes(finer_residual);
    auto to = at_nodes(residual_);
    for_each_sum(
        restriction_, n_threads_, [&](int column) { return from.col(column); },
        [&](std::ptrdiff_t node, const Eigen::Vector4f& sum) { to.col(node) = sum; });
  }
  void prolong_to(Field<float>& finer_correction) override {
    const auto from = at_nodes(solution_);
    auto to = at_nodes(finer_correction);
    for_each_sum(
        merged_.interpolation, n_threads_, [&](int column) { return from.col(column); },
        [&](std::ptrdiff_t node, const Eigen::Vector4f& sum) { to.col(node) = sum; });
  }

 protected:
  MergedCells merged_;
  Weights restriction_; ///< transpose of the interpolation

  /// Makes the level's matrix, and the inverse of its diagonal.
  /// @param of_finer  (cell of the finer level): its stiffness
  /// @param hold      (the same, weights of its corners by component): clears the rows of what is held
  template<class OfFiner, class Hold>
  void prepare(const OfFiner& of_finer, const Hold& hold) {
    gather_stiffness(of_finer, hold);
    assemble();
    invert_diagonal();
  }

 private:
  const MergedLevel* finer_;
  std::vector<CellMatrix> stiffness_;
  std::vector<int> row_, column_; ///< first block of each row; each block's column
  std::vector<Block> matrix_, inverse_;
  std::vector<std::array<int, 64>> blocks_of_cell_;
  mechanics::grid::DenseFactor<float> factor_;

  /// Makes the cells' stiffness from that of the finer cells.
  template<class OfFiner, class Hold>
  void gather_stiffness(const OfFiner& of_finer, const Hold& hold) {
    std::array<Corners, 8> weights; // finer corners by coarse ones, for each begin of a finer cell
    for (int begin = 0; begin < 8; ++begin)
      for (int v = 0; v < 8; ++v)
        for (int corner = 0; corner < 8; ++corner)
          weights[index(begin)](v, corner) = static_cast<float>(
              weight_at({begin & 1, (begin >> 1) & 1, begin >> 2}, merged_.factor, v, corner));
    const auto add = [&](std::size_t cell, CellMatrix& coarse) {
      const std::array<int, 3>& begin = merged_.begins_at[cell];
      const Corners& all = weights[index(begin[0] + 2 * begin[1] + 4 * begin[2])];
      std::array<Corners, 3> moved{all, all, all}; // what the corners' components are moved by
      hold(cell, moved);
      const CellMatrix finer = of_finer(cell);
      for (std::size_t p = 0; p < n_pairs; ++p) {
        const Corners half = finer[p].lazyProduct(moved[index(second_of_pair[p])]);
        coarse[p] += moved[index(first_of_pair[p])].transpose().lazyProduct(half);
      }
    };
    const auto n_coarse = static_cast<std::ptrdiff_t>(stiffness_.size());
    const auto gather = [&](std::ptrdiff_t at) {
      CellMatrix& coarse = stiffness_[index(at)];
      for (Corners& pair : coarse) pair.setZero();
      for (int f = merged_.first_finer[index(at)]; f < merged_.first_finer[index(at) + 1]; ++f)
        add(index(merged_.finer_cells[index(f)]), coarse);
    };
    mechanics::grid::on_threads(n_coarse, n_threads_, gather, cells_at_once);
  }

  void assemble() {
    for (Block& block : matrix_)
      for (Eigen::Vector4f& column : block) column.setZero();
    for (std::size_t cell = 0; cell < stiffness_.size(); ++cell) {
      const CellMatrix& of = stiffness_[cell];
      for (int a = 0; a < 8; ++a)
        for (int b = 0; b < 8; ++b) {
          Block& block = matrix_[index(blocks_of_cell_[cell][index(8 * a + b)])];
          for (std::size_t p = 0; p < n_pairs; ++p) {
            const int r = first_of_pair[p], c = second_of_pair[p];
            block[index(c)][r] += of[p](a, b);
            if (r != c) block[index(r)][c] += of[p](b, a);
          }
        }
    }
  }

  void invert_diagonal() {
    for (int node = 0; node < cells().n_nodes; ++node) {
      const auto begin = column_.begin() + row_[index(node)], end = column_.begin() + row_[index(node) + 1];
      const Block& own = matrix_[index(std::lower_bound(begin, end, node) - column_.begin())];
      Eigen::Matrix3d block;
      bool moves[3];
      for (int c = 0; c < 3; ++c) {
        block.col(c) = own[index(c)].head<3>().cast<double>();
        moves[c] = block(c, c) > 0;
      }
      const Eigen::Matrix3d inverse = mechanics::grid::inverse_on_free(block, moves, 1e-6);
      for (int c = 0; c < 3; ++c) inverse_[index(node)][index(c)] << inverse.col(c).cast<float>(), 0;
    }
  }
};

/// Merged cells on those of the finest body, whose fields have other places for its nodes.
class FirstMergedLevel : public MergedLevel {
 public:
  FirstMergedLevel(MergedCells merged, FinestCells finest_cells, const Body& finest,
                   const Field<float>& displacement, const Field<float>& added, int n_threads)
      : MergedLevel(std::move(merged), nullptr, n_threads), finest_(finest), fine_(std::move(finest_cells)),
        cell_tangent_(finest), displacement_(displacement), added_(added) {}

  void linearise() override {
    prepare([&](std::size_t cell) { return stiffness_of(cell); },
            [&](std::size_t cell, std::array<Corners, 3>& moved) {
              for (int v = 0; v < 8; ++v)
                for (std::size_t c = 0; c < 3; ++c)
                  if (fine_.is_held[index(fine_.cells.nodes[cell][index(v)])][c]) moved[c].row(v).setZero();
            });
  }

  void restrict_from(Field<float>& finer_residual) override { // which is 0 on constrained entries
    auto to = at_nodes(residual_);
    for_each_sum(
        restriction_, n_threads_,
        [&](int node) {
          const float* const x = finer_residual.data() + fine_.entry[index(node)];
          return Eigen::Vector4f(x[0], x[finest_.layout.size], x[2 * finest_.layout.size], 0);
        },
        [&](std::ptrdiff_t node, const Eigen::Vector4f& sum) { to.col(node) = sum; });
  }
  void prolong_to(Field<float>& finer_correction) override {
    finer_correction.setZero();
    const auto from = at_nodes(solution_);
    for_each_sum(
        merged_.interpolation, n_threads_, [&](int column) { return from.col(column); },
        [&](std::ptrdiff_t node, const Eigen::Vector4f& sum) {
          for (int c = 0; c < 3; ++c)
            if (!fine_.is_held[index(node)][index(c)])
              finer_correction[fine_.entry[index(node)] + c * finest_.layout.size] = sum[c];
        });
  }

 private:
  const Body& finest_;
  FinestCells fine_;
  CellTangent cell_tangent_;
  const Field<float>&displacement_, &added_;

  /// The clamped tangent of a cell of the finest body, with its share of what is added to the diagonal.
  CellMatrix stiffness_of(std::size_t cell) const {
    const auto& [i, j, k] = fine_.cells.places[cell];
    const std::array<int, 8>& nodes = fine_.cells.nodes[cell];
    const auto entry = [&](int v, int c) {
      return fine_.entry[index(nodes[index(v)])] + c * finest_.layout.size;
    };
    CellPositions moved;
    for (int v = 0; v < 8; ++v)
      for (int c = 0; c < 3; ++c) moved[index(v)][c] = static_cast<double>(displacement_[entry(v, c)]);
    CellMatrix matrix = cell_tangent_.at(finest_.cell(i, j, k), moved);
    for (int v = 0; added_.size() > 0 && v < 8; ++v)
      for (int c = 0; c < 3; ++c)
        matrix[index(c)](v, v) +=
            added_[entry(v, c)] / static_cast<float>(fine_.n_cells[index(nodes[index(v)])]);
    return matrix;
  }
};

} // namespace

void add_merged_levels(const Body& finest, const Field<float>& displacement, const Field<float>& added,
                       int n_threads, std::vector<std::unique_ptr<mechanics::grid::Level>>& levels) {
  std::array<int, 3> n_cells = finest.cells;
  Eigen::Vector3d spacing = finest.spacing;
  FinestCells finest_cells(finest);
  const MergedLevel* last = nullptr;
  while (!last || last->cells().n_nodes > n_nodes_factorised) {
    const auto factor = mechanics::grid::coarsening_factor(n_cells, spacing);
    if (!factor) break;
    MergedCells merged = merge(last ? last->cells() : finest_cells.cells, *factor);
    std::unique_ptr<MergedLevel> level;
    if (last)
      level = std::make_unique<MergedLevel>(std::move(merged), last, n_threads);
    else
      level = std::make_unique<FirstMergedLevel>(std::move(merged), std::move(finest_cells), finest,
                                                 displacement, added, n_threads);
    last = level.get();
    levels.push_back(std::move(level));
    for (std::size_t a = 0; a < 3; ++a) {
      spacing[static_cast<int>(a)] *= (*factor)[a];
      n_cells[a] = (n_cells[a] + (*factor)[a] - 1) / (*factor)[a];
    }
  }
}

} // namespace springproof::msm::grid
