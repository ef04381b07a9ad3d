#pragma once

#include "fem_reference/grid/inertia.hpp"
#include "mechanics/grid/smoother.hpp"

#include <Eigen/Cholesky>
#include <deque>

namespace springproof::fem_reference::grid {

/// The tangent of a body and an approximate inverse of it: one V-cycle in single precision. Coarse matrices
/// are Galerkin's, made cell by cell, which is exact because the grids are nested; the smoother is
/// Chebyshev's iteration on the block Jacobi method (Adams, Brezina, Hu, Tuminaro 2003), the same before and
/// after, so that the cycle is symmetric, if the tangent is; of another one the coarse matrices are the
/// symmetric part.
class Multigrid {
 public:
  Multigrid(const Body& body, int n_threads, const mechanics::grid::Chebyshev& smoother);

  /// Assembles the tangent at a state and prepares the cycle.
  /// @param inertia  whose matrix is added; or null
  void linearise(const double* displacement, const double* pressure, const Inertia* inertia = nullptr);

  /// Drops what a state far off may have left: largest eigenvalues that lead astray, and what is no number.
  void forget();

  /// product = tangent * field, whose ghosts are brought up to date; 0 on constrained entries when they are
  /// left out.
  enum class Rows { free, all };
  void product(Field<double>& field, Field<double>& product, Rows rows = Rows::free) const;

  /// solution = cycle(right_side).
  void apply(const Field<double>& right_side, Field<double>& solution);

  const Space& space() const { return levels_.front().space; }

 private:
  struct Level {
    explicit Level(const Space& the_space) : space(the_space) {}
    Space space;
    const Layout& layout() const { return space.layout; }
    std::array<bool, 3> axes{}; ///< along which the next level is coarser
    Coarsening coarsening{};
    std::vector<float> stencil, cell_matrices, inverse_diagonal; ///< the last: xx, yy, zz, yz, xz, xy
    Field<float> solution, residual, correction, product;
    Field<float> rough; ///< guess of the mode of the largest eigenvalue
    double largest_eigenvalue = 0;
  };

  const Body& body_;
  mechanics::grid::Chebyshev smoother_;
  std::deque<Level> levels_;
  std::vector<std::ptrdiff_t> coarsest_unknowns_;
  Eigen::LLT<Eigen::MatrixXd> coarsest_;

  bool is_finest(const Level& level) const { return &level == &levels_.front(); }
  void product(const Level& level, Field<float>& field, Field<float>& product) const;
  void add_damping(Level& level, Level* coarser, const Cells& damping) const;
  void add_to_diagonal(Level& level, const Field<double>& values) const;
  void invert_diagonal(Level& level) const;
  void estimate_largest_eigenvalue(Level& level) const;
  void factorise_coarsest();
  void correct(Level& level, bool keeps_residual) const;
  void smooth(Level& level, bool keeps_residual) const;
  void cycle(std::size_t l);
};

} // namespace springproof::fem_reference::grid
