#include "fem_reference/grid/multigrid.hpp"

#include "cases/mesh/hex_mesh.hpp"
#include "fem_reference/grid/transfer.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <random>
#include <utility>

namespace springproof::fem_reference::grid {

namespace {

using mechanics::grid::apply_blocks;

using cases::index;

constexpr std::ptrdiff_t most_coarsest_nodes = 125;
constexpr std::ptrdiff_t own_block = 9 * 13; ///< of a node's row of the stencil

std::ptrdiff_t n_nodes(const std::array<int, 3>& cells) {
  return std::ptrdiff_t{cells[0] + 1} * (cells[1] + 1) * (cells[2] + 1);
}

/// The same random vector on any number of ranks.
void fill(const Space& space, Field<float>& field) {
  const Layout& layout = space.layout;
  std::mt19937 generator(7);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (int k = -space.slab.first_of_grid(); k < layout.nodes[2]; ++k)
    for (int c = 0; c < 3; ++c)
      for (int j = 0; j < layout.nodes[1]; ++j)
        for (int i = 0; i < layout.nodes[0]; ++i) {
          const float value = uniform(generator);
          if (k >= 0) field[c * layout.size + layout.at(i, j, k)] = value;
        }
}

} // namespace

Multigrid::Multigrid(const Body& body, int n_threads, const mechanics::grid::Chebyshev& smoother)
    : body_(body), smoother_(smoother) {
  std::array<int, 3> cells = body.cells_of_grid();
  Eigen::Vector3d spacing = body.spacing;
  Slab slab = body.slab;
  for (;;) {
    Level& level =
        levels_.emplace_back(Space{make_layout({cells[0], cells[1], slab.n_layers()}), slab, n_threads});
    const Layout& layout = level.layout();
    level.stencil.resize(index(stencil_row(layout) * layout.nodes[1] * layout.nodes[2]));
    level.inverse_diagonal.resize(index(6 * layout.size));
    for (Field<float>* field :
         {&level.solution, &level.residual, &level.correction, &level.product, &level.rough})
      field->setZero(3 * layout.size);
    if (levels_.size() > 1) level.cell_matrices.resize(index(n_upper * layout.n_cell_entries() + 16));
    const std::array<bool, 3> axes = axes_to_coarsen(cells, spacing);
    if (n_nodes(cells) <= most_coarsest_nodes || !(axes[0] || axes[1] || axes[2])) break;
    level.axes = axes;
    for (std::size_t a = 0; a < 3; ++a) {
      level.coarsening.axes[a] = axes[a];
      if (!axes[a]) continue;
      cells[a] = (cells[a] + 1) / 2;
      spacing[static_cast<int>(a)] *= 2;
    }
    const int first = slab.first_of_grid();
    slab = coarsen(slab, cells, axes[2]);
    level.coarsening.layout = make_layout({cells[0], cells[1], slab.n_layers()});
    level.coarsening.first = first;
    level.coarsening.first_coarse = slab.first_of_grid();
    level.rough.setZero(3 * layout.size);
    fill(level.space, level.rough);
  }
}

void Multigrid::linearise(const double* displacement, const double* pressure, const Inertia* inertia) {
  const Cells view = body_.view();
  const Masses masses = inertia ? inertia->step_masses() : Masses{};
  Field<double> of_nodes; // their masses; on coarser grids P^T m P by its sums of rows
  if (inertia && inertia->step_node_masses().size() > 0)
    of_nodes = inertia->step_node_masses().cwiseProduct(body_.free.cast<double>());
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    Level& level = levels_[l];
    Level* const coarser = l + 1 < levels_.size() ? &levels_[l + 1] : nullptr;
    for (std::vector<float>* zeroed : {&level.stencil, coarser ? &coarser->cell_matrices : nullptr})
      if (zeroed)
        for_each_piece(
            static_cast<std::ptrdiff_t>(zeroed->size()), level.space.n_threads,
            [&](std::ptrdiff_t first, std::ptrdiff_t n) { std::fill_n(zeroed->begin() + first, n, 0.0f); });
    const TangentFields fields{displacement,
                               pressure,
                               body_.free.data(),
                               level.stencil.data(),
                               coarser ? coarser->cell_matrices.data() : nullptr,
                               inertia ? &masses : nullptr};
    for_each_layer(level.space.slab, level.space.n_threads, [&](int k) {
      if (l == 0)
        kernels().tangent(view, fields, level.coarsening, k);
      else
        kernels().deposit(level.layout(), level.cell_matrices.data(), fields.stencil, fields.coarse,
                          level.coarsening, k);
    });
    if (const auto damping = l == 0 && inertia ? inertia->step_damping() : std::nullopt)
      add_damping(level, coarser, *damping);
    if (of_nodes.size() > 0) add_to_diagonal(level, of_nodes);
    if (coarser)
      coarser->space.slab.complete_layers(coarser->cell_matrices.data(),
                                          n_upper * coarser->layout().cell(0, 0, 1));
    invert_diagonal(level);
    if (coarser) estimate_largest_eigenvalue(level);
    if (!coarser || of_nodes.size() == 0) continue;
    Field<double> fine = std::exchange(of_nodes, Field<double>::Zero(3 * coarser->layout().size));
    restrict(level.space, coarser->space, level.axes, fine, of_nodes);
  }
  factorise_coarsest();
}

/// The tangent at rest of the body that damping is made of.
void Multigrid::add_damping(Level& level, Level* coarser, const Cells& damping) const {
  const Field<double> rest = Field<double>::Zero(3 * level.layout().size);
  const std::vector<double> no_pressure(index(level.layout().n_cell_entries()) + 16, 0.);
  const TangentFields fields{rest.data(), no_pressure.data(), body_.free.data(), level.stencil.data(),
                             coarser ? coarser->cell_matrices.data() : nullptr};
  for_each_layer(level.space.slab, level.space.n_threads,
                 [&](int k) { kernels().tangent(damping, fields, level.coarsening, k); });
}

void Multigrid::add_to_diagonal(Level& level, const Field<double>& values) const {
  const Layout& layout = level.layout();
  for_each_plane(level.space.slab.computed(), level.space.n_threads, [&](int k) {
    for (int j = 0; j < layout.nodes[1]; ++j) {
      float* const row = level.stencil.data() + stencil_row(layout) * layout.node_row(j, k);
      for (int c = 0; c < 3; ++c)
        for (int i = 0; i < layout.nodes[0]; ++i)
          row[(own_block + 4 * c) * layout.row + i] +=
              static_cast<float>(values[c * layout.size + layout.at(i, j, k)]);
    }
  });
}

void Multigrid::product(Field<double>& field, Field<double>& product, Rows rows) const {
  const Level& level = levels_.front();
  level.space.slab.update_ghosts(level.layout(), field.data());
  for_each_plane(level.space.slab.computed(), level.space.n_threads, [&](int k) {
    kernels().product(level.layout(), level.stencil.data(), field.data(),
                      rows == Rows::free ? body_.free.data() : nullptr, product.data(), k);
  });
}

void Multigrid::product(const Level& level, Field<float>& field, Field<float>& product) const {
  level.space.slab.update_ghosts(level.layout(), field.data());
  for_each_plane(level.space.slab.computed(), level.space.n_threads, [&](int k) {
    kernels().product_float(level.layout(), level.stencil.data(), field.data(),
                            is_finest(level) ? body_.free.data() : nullptr, product.data(), k);
  });
}

/// Of the blocks without constrained entries; those, and entries without a cell, become 0.
void Multigrid::invert_diagonal(Level& level) const {
  const Layout& layout = level.layout();
  for_each_plane(level.space.slab.computed(), level.space.n_threads, [&](int k) {
    for (int j = 0; j < layout.nodes[1]; ++j)
      for (int i = 0; i < layout.nodes[0]; ++i) {
        const float* entry = level.stencil.data() + stencil_row(layout) * layout.node_row(j, k) + i;
        const std::ptrdiff_t at = layout.at(i, j, k);
        Eigen::Matrix3d block;
        bool is_free[3];
        for (int c = 0; c < 3; ++c)
          for (int d = 0; d < 3; ++d)
            block(c, d) = static_cast<double>(entry[(own_block + 3 * c + d) * layout.row]);
        for (int c = 0; c < 3; ++c) {
          is_free[c] = block(c, c) != 0 && (!is_finest(level) || body_.free[c * layout.size + at] > 0);
          if (is_free[c]) continue;
          block.row(c).setZero();
          block.col(c).setZero();
          block(c, c) = 1;
        }
        Eigen::Matrix3d inverse = block.inverse();
        // positive definite: otherwise the sizes of the diagonal must do
        const Eigen::LLT<Eigen::Matrix3d> factor(block);
        if (factor.info() != Eigen::Success || !(block.determinant() > 1e-9 * block.diagonal().prod()))
          inverse = block.diagonal().cwiseAbs().cwiseInverse().asDiagonal();
        for (int c = 0; c < 3; ++c)
          if (!is_free[c]) inverse(c, c) = 0;
        const double six[6] = {inverse(0, 0), inverse(1, 1), inverse(2, 2),
                               inverse(1, 2), inverse(0, 2), inverse(0, 1)};
        for (int e = 0; e < 6; ++e)
          level.inverse_diagonal[index(e * layout.size + at)] = static_cast<float>(six[e]);
      }
  });
}

void Multigrid::forget() {
  for (Level& level : levels_) {
    level.largest_eigenvalue = 0;
    for (Field<float>* field :
         {&level.solution, &level.residual, &level.correction, &level.product, &level.rough})
      field->setZero(); // 0 times what is not a number is not 0
    if (level.rough.size() > 0) fill(level.space, level.rough);
  }
}

/// Of the inverse diagonal times the matrix, by the power method; its vector is kept for the next time.
void Multigrid::estimate_largest_eigenvalue(Level& level) const {
  const int n_steps = level.largest_eigenvalue > 0 ? 2 : 8;
  for (int step = 0; step < n_steps; ++step) {
    const double norm = grid::norm(level.space, level.rough);
    product(level, level.rough, level.product);
    apply_blocks(level.inverse_diagonal.data(), level.product, level.rough, 0, static_cast<float>(1 / norm),
                 level.space.n_threads);
    level.largest_eigenvalue = grid::norm(level.space, level.rough);
  }
}

void Multigrid::factorise_coarsest() {
  const Level& level = levels_.back();
  const Layout& layout = level.layout();
  std::vector<int> number(index(3 * layout.size), -1);
  coarsest_unknowns_.clear();
  const auto for_each_node = [&](const auto& action) {
    for (int k = 0; k < layout.nodes[2]; ++k)
      for (int j = 0; j < layout.nodes[1]; ++j)
        for (int i = 0; i < layout.nodes[0]; ++i) action(i, j, k);
  };
  for_each_node([&](int i, int j, int k) {
    for (int c = 0; c < 3; ++c) {
      const std::ptrdiff_t entry = c * layout.size + layout.at(i, j, k);
      if (level.inverse_diagonal[index(entry)] == 0) continue;
      number[index(entry)] = static_cast<int>(coarsest_unknowns_.size());
      coarsest_unknowns_.push_back(entry);
    }
  });
  const auto n = static_cast<Eigen::Index>(coarsest_unknowns_.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  for_each_node([&](int i, int j, int k) {
    const float* entry = level.stencil.data() + stencil_row(layout) * layout.node_row(j, k) + i;
    for (int e = 0; e < n_stencil; ++e, entry += layout.row) {
      const int neighbour = e / 9, c = e % 9 / 3, d = e % 3;
      const std::ptrdiff_t at = layout.at(i, j, k), other = at + neighbour % 3 - 1 +
                                                            (neighbour / 3 % 3 - 1) * layout.row +
                                                            (neighbour / 9 - 1) * layout.plane;
      const int row = number[index(c * layout.size + at)];
      if (row < 0 || *entry == 0) continue;
      const int column = number[index(d * layout.size + other)];
      if (column >= 0) matrix(row, column) = static_cast<double>(*entry);
    }
  });
  matrix = 0.5 * (matrix + matrix.transpose()).eval();
  // Single precision leaves the matrix uncertain by about 1e-7 of its diagonal; a preconditioner may be that
  // stiff.
  const double shift = n > 0 ? 1e-6 * matrix.diagonal().cwiseAbs().maxCoeff() : 0;
  matrix.diagonal().array() += shift;
  coarsest_.compute(matrix);
  if (coarsest_.info() == Eigen::Success) return;
  // A preconditioner has to be positive: sizes of eigenvalues in place of eigenvalues.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(matrix);
  const Eigen::VectorXd sizes = modes.eigenvalues().cwiseAbs().cwiseMax(shift);
  coarsest_.compute(modes.eigenvectors() * sizes.asDiagonal() * modes.eigenvectors().transpose());
}

/// Adds the correction to the solution, and takes its product from the residual when that is wanted.
void Multigrid::correct(Level& level, bool keeps_residual) const {
  add(level.solution, 1.0f, level.correction, level.space.n_threads);
  if (!keeps_residual) return;
  product(level, level.correction, level.product);
  add(level.residual, -1.0f, level.product, level.space.n_threads);
}

void Multigrid::smooth(Level& level, bool keeps_residual) const {
  const auto precondition = [&](float keep, float factor) {
    apply_blocks(level.inverse_diagonal.data(), level.residual, level.correction, keep, factor,
                 level.space.n_threads);
  };
  mechanics::grid::smooth(
      smoother_, 1.1 * level.largest_eigenvalue, // the power method comes from below
      precondition, [&](bool keeps) { correct(level, keeps); }, keeps_residual);
}

/// Solves for the residual of level l; the level's solution is the answer.
void Multigrid::cycle(std::size_t l) {
  Level& level = levels_[l];
  level.solution.setZero();
  if (l + 1 == levels_.size()) {
    const auto n = static_cast<Eigen::Index>(coarsest_unknowns_.size());
    Eigen::VectorXd right(n);
    for (Eigen::Index i = 0; i < n; ++i)
      right[i] = static_cast<double>(level.residual[coarsest_unknowns_[index(i)]]);
    const Eigen::VectorXd solution = coarsest_.solve(right);
    for (Eigen::Index i = 0; i < n; ++i)
      level.solution[coarsest_unknowns_[index(i)]] = static_cast<float>(solution[i]);
    return;
  }
  Level& coarser = levels_[l + 1];
  smooth(level, true);
  restrict(level.space, coarser.space, level.axes, level.residual, coarser.residual);
  cycle(l + 1);
  prolong(coarser.space, level.space, level.axes, coarser.solution, level.correction);
  if (is_finest(level)) level.correction.array() *= body_.free.array();
  correct(level, true);
  smooth(level, false);
}

void Multigrid::apply(const Field<double>& right_side, Field<double>& solution) {
  Level& level = levels_.front();
  mechanics::grid::apply_in_single_precision(
      right_side, grid::norm(level.space, right_side), level.residual, level.solution, solution,
      [&] { cycle(0); }, level.space.n_threads);
}

} // namespace springproof::fem_reference::grid
