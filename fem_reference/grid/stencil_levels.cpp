#include "fem_reference/grid/stencil_levels.hpp"

#include "cases/mesh/mesh.hpp"

namespace springproof::fem_reference::grid {

using cases::index;

namespace {

constexpr std::ptrdiff_t most_coarsest_nodes = 125;
constexpr std::ptrdiff_t own_block = 9 * 13; ///< a node's own block begins there in its row of the stencil

std::ptrdiff_t n_nodes(const std::array<int, 3>& cells) {
  return std::ptrdiff_t{cells[0] + 1} * (cells[1] + 1) * (cells[2] + 1);
}

} // namespace

/// A matrix between each node and its neighbours.
class StencilLevels::StencilLevel : public mechanics::grid::Level {
 public:
  /// @param finer, factor  null and ones: this is the finest level
  /// @param body, state    the finest level's; must outlive this
  StencilLevel(const Space& space, StencilLevel* finer, const std::array<int, 3>& factor, const Body& body,
               const State& state)
      : Level(3 * space.layout.size, space.n_threads), space_(space), finer_(finer), body_(body),
        state_(state), factor_(factor),
        stencil_(index(stencil_row(space.layout) * space.layout.nodes[1] * space.layout.nodes[2])) {
    inverse_diagonal_.setZero(6 * layout().size);
    if (is_finest()) return;
    cell_matrices_.resize(index(n_upper * layout().n_cell_entries() + 16));
    transfer_.emplace(finer->space_, space_, factor);
    finer->coarser_ = this;
    finer->coarsening_ = {layout(),
                          {factor[0] == 2, factor[1] == 2, factor[2] == 2},
                          finer->space_.slab.first_of_grid(),
                          space_.slab.first_of_grid()};
  }

  /// product = matrix * field, in double precision
  void product(Field<double>& field, const float* free, Field<double>& product) const {
    space_.slab.update_ghosts(layout(), field.data());
    for_each_plane(space_.slab.computed(), n_threads_, [&](int k) {
      kernels().product(layout(), stencil_.data(), field.data(), free, product.data(), k);
    });
  }

  void linearise() override {
    set_to_zero(stencil_);
    if (coarser_) set_to_zero(coarser_->cell_matrices_);
    if (is_finest())
      add_tangent();
    else
      for_each_layer(space_.slab, n_threads_, [&](int k) {
        kernels().deposit(layout(), cell_matrices_.data(), stencil_.data(), next_cell_matrices(), coarsening_,
                          k);
      });
    if (node_masses_.size() > 0) add_node_masses();
    invert_diagonal();
    if (!coarser_) return;
    coarser_->space_.slab.complete_layers(coarser_->cell_matrices_.data(),
                                          n_upper * coarser_->layout().cell(0, 0, 1));
    coarser_->node_masses_.setZero(node_masses_.size() > 0 ? 3 * coarser_->layout().size : 0);
    if (node_masses_.size() > 0)
      Transfer<double>(space_, coarser_->space_, coarser_->factor_)
          .restrict(node_masses_, coarser_->node_masses_);
  }
  void multiply(Field<float>& direction, Field<float>& product) const override {
    space_.slab.update_ghosts(layout(), direction.data());
    for_each_plane(space_.slab.computed(), n_threads_, [&](int k) {
      kernels().product_float(layout(), stencil_.data(), direction.data(),
                              is_finest() ? body_.free.data() : nullptr, product.data(), k);
    });
  }
  double norm(const Field<float>& field) const override { return grid::norm(space_, field); }
  void set_rough(Field<float>& rough) const override {
    rough = mechanics::grid::random_field<float>(layout(), {0, 0, space_.slab.first_of_grid()}, 7,
                                                 std::uniform_real_distribution<float>(-1, 1));
  }
  bool factorise() override {
    Eigen::MatrixXd& matrix = factorisation_.begin(
        3 * layout().size, [&](std::ptrdiff_t entry) { return inverse_diagonal_[entry] != 0; });
    const std::vector<int>& number = factorisation_.number;
    mechanics::grid::for_each_place(layout().nodes, [&](int i, int j, int k) {
      const float* entry = stencil_.data() + row(j, k) + i;
      for (int e = 0; e < n_stencil; ++e, entry += layout().row) {
        const int neighbour = e / 9, c = e % 9 / 3, d = e % 3;
        const std::ptrdiff_t at = layout().at(i, j, k), other = at + neighbour % 3 - 1 +
                                                                (neighbour / 3 % 3 - 1) * layout().row +
                                                                (neighbour / 9 - 1) * layout().plane;
        const int of_row = number[index(c * layout().size + at)];
        if (of_row < 0 || *entry == 0) continue;
        const int column = number[index(d * layout().size + other)];
        if (column >= 0) matrix(of_row, column) = static_cast<double>(*entry);
      }
    });
    factorisation_.factorise(decltype(factorisation_)::Indefinite::reflect);
    return true;
  }
  void solve_exactly() override { factorisation_.solve(residual_, solution_); }
  void restrict_from(Field<float>& finer_residual) override {
    transfer_->restrict(finer_residual, residual_);
  }
  void prolong_to(Field<float>& finer_correction) override {
    transfer_->prolong(solution_, finer_correction);
    if (finer_->is_finest()) finer_correction.array() *= body_.free.array();
  }

 private:
  Space space_;
  StencilLevel *finer_, *coarser_ = nullptr;
  const Body& body_;
  const State& state_;
  std::optional<Transfer<float>> transfer_; ///< from the finer level and back
  std::array<int, 3> factor_;               ///< finer cells along each axis of one here
  Coarsening coarsening_{};                 ///< to the coarser level
  std::vector<float> stencil_, cell_matrices_;
  Field<double> node_masses_; ///< added to the diagonal; on coarser grids P^T m P by its sums of rows
  mechanics::grid::DenseFactor<double> factorisation_;

  bool is_finest() const { return !finer_; }
  const Layout& layout() const { return space_.layout; }
  std::ptrdiff_t row(int j, int k) const { return stencil_row(layout()) * layout().node_row(j, k); }
  float* next_cell_matrices() { return coarser_ ? coarser_->cell_matrices_.data() : nullptr; }
  void set_to_zero(std::vector<float>& values) const {
    for_each_piece(
        static_cast<std::ptrdiff_t>(values.size()), n_threads_,
        [&](std::ptrdiff_t first, std::ptrdiff_t n) { std::fill_n(values.begin() + first, n, 0.0f); });
  }

  /// Adds the tangent of the body, with its inertia, and its cells' matrices on the coarser grid.
  void add_tangent() {
    const auto add = [&](const Cells& cells, const double* displacement, const double* internal,
                         const Masses<double>* masses) {
      const TangentFields fields{displacement,         internal, body_.free.data(), stencil_.data(),
                                 next_cell_matrices(), masses};
      for_each_layer(space_.slab, n_threads_,
                     [&](int k) { kernels().tangent(cells, fields, coarsening_, k); });
    };
    const Inertia* const inertia = state_.inertia;
    const Masses<double> masses = inertia ? inertia->step_masses() : Masses<double>{};
    add(body_.view(), state_.displacement, state_.internal, inertia ? &masses : nullptr);
    node_masses_.resize(0);
    if (!inertia) return;
    if (inertia->step_node_masses().size() > 0)
      node_masses_ = inertia->step_node_masses().cwiseProduct(body_.free.cast<double>());
    if (const auto damping = inertia->step_damping()) { // the damping body's tangent at rest
      const Field<double> rest = Field<double>::Zero(3 * layout().size);
      const std::vector<double> internal(index(body_.n_internal()), 0.);
      add(*damping, rest.data(), internal.data(), nullptr);
    }
  }

  void add_node_masses() {
    for_each_plane(space_.slab.computed(), n_threads_, [&](int k) {
      for (int j = 0; j < layout().nodes[1]; ++j) {
        float* const entry = stencil_.data() + row(j, k);
        for (int c = 0; c < 3; ++c)
          for (int i = 0; i < layout().nodes[0]; ++i)
            entry[(own_block + 4 * c) * layout().row + i] +=
                static_cast<float>(node_masses_[layout().at(i, j, k, c)]);
      }
    });
  }

  /// Inverts blocks without their constrained entries; those, and entries without a cell, become 0.
  void invert_diagonal() {
    static constexpr int first_of_pair[6] = {0, 1, 2, 1, 0, 0}, second_of_pair[6] = {0, 1, 2, 2, 2, 1};
    for_each_plane(space_.slab.computed(), n_threads_, [&](int k) {
      for (int j = 0; j < layout().nodes[1]; ++j)
        for (int i = 0; i < layout().nodes[0]; ++i) {
          const float* const entry = stencil_.data() + row(j, k) + i;
          const std::ptrdiff_t at = layout().at(i, j, k);
          Eigen::Matrix3d block;
          bool is_free[3];
          for (int c = 0; c < 3; ++c)
            for (int d = 0; d < 3; ++d)
              block(c, d) = static_cast<double>(entry[(own_block + 3 * c + d) * layout().row]);
          for (int c = 0; c < 3; ++c)
            is_free[c] = block(c, c) != 0 && (!is_finest() || body_.free[c * layout().size + at] > 0);
          const Eigen::Matrix3d inverse = mechanics::grid::inverse_on_free(block, is_free, 1e-9);
          for (int e = 0; e < 6; ++e)
            inverse_diagonal_[e * layout().size + at] =
                static_cast<float>(inverse(first_of_pair[e], second_of_pair[e]));
        }
    });
  }
};

StencilLevels::StencilLevels(const Body& body, int n_threads, const mechanics::grid::Chebyshev& smoother)
    : body_(body), space_(body.space(n_threads)), cycle_({smoother, 1.1, 8}, n_threads) {
  std::array<int, 3> cells = body.cells_of_grid(), factor{1, 1, 1};
  Eigen::Vector3d spacing = body.spacing;
  Slab slab = body.slab;
  for (StencilLevel* last = nullptr;;) {
    const Space space{make_layout({cells[0], cells[1], slab.n_layers()}), slab, n_threads};
    auto level = std::make_unique<StencilLevel>(space, last, factor, body, state_);
    last = level.get();
    if (!finest_) finest_ = last;
    cycle_.levels.push_back(std::move(level));
    const auto next = mechanics::grid::coarsening_factor(cells, spacing);
    if (n_nodes(cells) <= most_coarsest_nodes || !next) break;
    factor = *next;
    for (std::size_t a = 0; a < 3; ++a) {
      cells[a] = (cells[a] + factor[a] - 1) / factor[a];
      spacing[static_cast<int>(a)] *= factor[a];
    }
    slab = coarsen(slab, cells, factor[2] == 2);
  }
}

void StencilLevels::linearise(const double* displacement, const double* internal, const Inertia* inertia) {
  state_ = {displacement, internal, inertia};
  cycle_.linearise();
}

void StencilLevels::product(Field<double>& field, Field<double>& product, Rows rows) const {
  finest_->product(field, rows == Rows::free ? body_.free.data() : nullptr, product);
}

} // namespace springproof::fem_reference::grid
