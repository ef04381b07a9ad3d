#pragma once

#include "fem_reference/grid/multigrid.hpp"
#include "fem_reference/grid/quadratic_elements.hpp"
#include "fem_reference/grid/supported.hpp"
#include "mechanics/equilibrium/nonlinear_problem.hpp"

namespace springproof::fem_reference::grid {

/// The equilibrium equations of a body on a grid, without a factorisation. A state is the displacement of the
/// nodes (mm), then the pressures of the cells (MPa), where they have one; of a rank, those of all nodes and
/// cells that its slab holds. Supports are part of the equations, as in EquilibriumEquations. Every member
/// function that evaluates a state is collective.
class GridEquations : public mechanics::NonlinearProblem {
 public:
  /// @param body, supported  must outlive this
  /// @param quadratic  elements on the body's nodes in place of its own, or null; must outlive this
  /// @param volume_tolerance  on what a cell's pressure leaves of its volume, relative; as of the assembled
  ///                          equations
  GridEquations(const Body& body, const Supported& supported, int n_threads,
                QuadraticElements* quadratic = nullptr, double volume_tolerance = 1e-12);

  using Vector = mechanics::Vector;
  Vector rest() const { return Vector::Zero(n_displacements() + n_pressures()); }
  Eigen::Index n_displacements() const { return 3 * body_.layout.size; }
  Eigen::Index n_pressures() const { return body_.has_modes ? body_.layout.n_cell_entries() + 16 : 0; }

  Vector residual(const Vector& at, double load_factor, mechanics::Expect expect) override;
  Size size(const Vector& residual, const Vector& at) override;
  std::optional<Vector> direction(const Vector& at, const Vector& residual, double load_factor,
                                  double forcing, mechanics::Convexity convexity) override;
  mechanics::Merit merit() const override;
  std::optional<bool> is_stable(const Vector& at) override;
  double dot(const Vector& left, const Vector& right) const override; ///< of the displacements
  bool any_rank(bool here) const override { return space_.slab.largest(here ? 1 : 0) > 0; }
  Work work() const override { return work_; }
  std::size_t n_unknowns() const override; ///< collective

  /// The next direction is of its own state's tangent, and of nothing that was learnt on the way.
  void forget_tangent() {
    has_tangent_ = false;
    multigrid_.forget();
  }

  /// Negative eigenvalues that is_stable() counted.
  std::optional<int> negative_eigenvalues() const { return negative_eigenvalues_; }
  /// Deformed volumes, mm³, per cell entry of the elements.
  std::vector<double> cell_volumes(const Vector& at) const;

 private:
  const Body& body_;
  const Supported& supported_;
  Space space_;
  QuadraticElements* quadratic_;
  Multigrid multigrid_;
  double load_norm_, volume_tolerance_;
  Work work_;
  bool has_tangent_ = false;
  double norm_before_ = 0;  ///< of the right side that the tangent was last used for, N
  Field<double> condensed_; ///< of the state last evaluated: force with the pressures' imbalance, N
  std::vector<double> gap_; ///< of the moved entries there, mm
  double largest_gap_ = 0, reaction_ = 0, volume_mismatch_ = 0;
  bool is_valid_ = false;
  std::optional<int> negative_eigenvalues_;

  bool add_force(const Vector& at, Field<double>& force);
  void linearise(const Vector& at);
  void product(Field<double>& field, Field<double>& product) const;
  bool may_keep_tangent(double norm) const;
  std::optional<Field<double>> solve(const Field<double>& right_side, double target);
  bool is_linear() const { return body_.law == Law::small_strain; }
};

} // namespace springproof::fem_reference::grid
