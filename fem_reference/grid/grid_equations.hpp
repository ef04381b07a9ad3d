#pragma once

#include "fem_reference/element_equations.hpp"
#include "fem_reference/grid/quadratic_elements.hpp"
#include "fem_reference/grid/stencil_levels.hpp"
#include "mechanics/grid/coarse_guess.hpp"

#include <memory>

namespace springproof::fem_reference::grid {

/// Relative volume that a cell's pressure may leave unbalanced, at a tolerance on residuals.
constexpr double volume_tolerance_of(double residual_tolerance) {
  return 1e-2 * residual_tolerance;
}

/// The equations of a body on a grid, in equilibrium or in motion, without a factorisation. A state is the
/// displacement of the nodes (mm), then the pressures (MPa) or bubbles (mm) of the cells, where they have
/// any; a rank has those of all nodes and cells that its slab holds. Forces are right in the planes that a
/// rank computes. Supports are part of the equations, as in EquilibriumEquations; the cells' unknowns have no
/// inertia. Every member function that evaluates a state is collective.
class GridEquations : public ElementEquations {
 public:
  /// @param body, supported  must outlive this
  /// @param quadratic  elements on the body's nodes in place of its own, or null; must outlive this
  /// @param volume_tolerance  relative volume that a cell's pressure may leave unbalanced; the assembled
  ///                          equations have the same default
  GridEquations(const Body& body, const Supported& supported, int n_threads,
                QuadraticElements* quadratic = nullptr, double volume_tolerance = 1e-12);

  using Vector = mechanics::Vector;
  Vector rest() const override { return Vector::Zero(n_displacements() + body_.n_internal()); }
  Eigen::Index n_displacements() const { return 3 * body_.layout.size; }

  using NonlinearProblem::direction;
  using NonlinearProblem::residual;
  void residual(const Vector& at, double load_factor, mechanics::Expect expect, Vector& residual) override;
  Size size(const Vector& residual, const Vector& at) override;
  bool direction(const Vector& at, const Vector& residual, double load_factor, double forcing,
                 mechanics::Convexity convexity, Vector& step) override;
  std::optional<bool> is_stable(const Vector& at) override;
  double dot(const Vector& left, const Vector& right) const override; ///< the displacements alone
  bool any_rank(bool here) const override { return space_.slab.largest(here ? 1 : 0) > 0; }
  std::vector<Run> runs() const override;
  Work work() const override { return work_; }
  std::size_t n_unknowns() const override; ///< collective

  /// Gives the body a scene's masses, damping and loads in time, which the functions below use.
  /// @param scene   the scene on the elements' mesh   @param places  the body's
  void set_in_motion(const cases::Scene& scene, const Places& places);
  void mass_product(const Vector& motion, Vector& product) override { multiply({1, 0}, motion, product); }
  void damping_product(const Vector& motion, Vector& product) override { multiply({0, 1}, motion, product); }
  void supports_at(double time, Vector& displacement) const override;
  /// The cells' unknowns follow from displacements in each step.
  void complete(Vector& motion) override { body_.slab.update_ghosts(body_.layout, motion.data()); }
  /// Makes residuals those of the step, relative to its scale, whatever the load factor.
  void set_step(const mechanics::StepTerms& terms) override;

  /// Makes the next direction use the tangent of its own state, and nothing learnt before.
  void forget_tangent() {
    has_tangent_ = false;
    multigrid_.forget();
  }

  void set_volume_tolerance(double tolerance) { volume_tolerance_ = tolerance; }
  bool linear_solver_failed() const override { return has_failed_; }
  /// Deformed volumes, mm³, per cell entry of the elements.
  std::vector<double> cell_volumes(const Vector& at) const;

 private:
  const Body& body_;
  const Supported& supported_;
  Space space_;
  QuadraticElements* quadratic_;
  StencilLevels multigrid_;
  double volume_tolerance_;
  Work work_;
  bool has_tangent_ = false;
  double norm_before_ = 0;           ///< norm of the right side last solved for, N
  std::unique_ptr<Inertia> inertia_; ///< null unless the body is in motion
  Field<double> motion_, product_;
  bool begins_step_ = false;    ///< this step has had no direction yet
  bool is_easy_ = true;         ///< every iteration of the step gained much
  bool carries_tangent_ = true; ///< a step begins with the tangent of the one before
  Field<double> condensed_;     ///< force with the imbalance of the cells' unknowns, in the last state, N
  std::vector<double> gap_;     ///< gaps of the moved entries there, mm
  double reaction_ = 0, volume_mismatch_ = 0;
  std::vector<double> bubble_imbalance_; ///< squared forces on the bubbles of each layer of cells, N²
  bool is_valid_ = false, has_failed_ = false;

  bool add_force(const Vector& at, Field<double>& force);
  void add_inertia(const Vector& at, Field<double>& force);
  void multiply(const Inertia::Factors& factors, const Vector& motion, Vector& product);
  void linearise(const Vector& at);
  void product(Field<double>& field, Field<double>& product) const;
  bool may_keep_tangent(double norm) const;
  std::optional<Field<double>> solve(const Field<double>& right_side, double target);
};

/// The equilibrium of the body in cells twice as large, found the same way and interpolated. A body too small
/// to be worth it tells nothing.
mechanics::grid::CoarseGuess coarse_guess(const Body& body, const Supported& supported, double load_factor,
                                          int n_threads);

} // namespace springproof::fem_reference::grid
