#pragma once

#include "cases/scene/scene.hpp"
#include "mechanics/dynamics/dynamic_problem.hpp"

#include <algorithm>

namespace springproof::fem_reference {

/// The equations of finite elements by either backend, in equilibrium and in motion.
class ElementEquations : public mechanics::DynamicProblem {
 public:
  virtual mechanics::Vector rest() const = 0;
  /// Negative eigenvalues that is_stable() counted.
  std::optional<int> negative_eigenvalues() const { return negative_eigenvalues_; }
  /// Whether the last direction was not found.
  virtual bool linear_solver_failed() const { return false; }

  /// Merit of a line search: the work, or none where cells have unknowns of their own, while supports still
  /// move, or when one step is exact. Friction needs a search in any case: full steps go back and forth
  /// between sticking and slipping. The pressures of cells follow a step to second order, so that the work on
  /// displacements alone is the slope of the energy.
  mechanics::Merit merit() const override {
    const bool is_saddle = has_internal_ && !has_friction();
    return is_saddle || is_linear_ || largest_gap_ > 0 ? mechanics::Merit::none : mechanics::Merit::work;
  }
  virtual bool has_friction() const { return false; }
  void external_force(double time, mechanics::Vector& force) override {
    force = rest();
    for (const mechanics::LoadInTime& load : loads_) load.add(time, force);
  }

 protected:
  /// @param has_internal  whether cells have unknowns of their own: pressures or bubbles
  /// @param is_linear     whether one step solves the equations
  ElementEquations(bool has_internal, bool is_linear) : has_internal_(has_internal), is_linear_(is_linear) {}

  const bool has_internal_, is_linear_;
  double load_norm_ = 0;   ///< N, on free degrees of freedom
  double largest_gap_ = 0; ///< mm: largest distance of a support from where it has to be
  std::optional<mechanics::StepTerms> step_;
  std::optional<int> negative_eigenvalues_;

  /// Takes the loads of a motion.
  /// @param load_of  (scene with one of the loads): its force, 0 on constrained degrees of freedom
  template<class LoadOf>
  void set_loads(const cases::Scene& scene, const LoadOf& load_of) {
    cases::Scene alone = scene;
    for (const auto& applied : scene.loads) {
      alone.loads = {applied};
      loads_.emplace_back(applied.load.history, load_of(alone));
    }
  }

  /// Scale of residuals, N. A body moved by prescribed displacements alone is measured against its reactions;
  /// one in motion that is moved by them, against these if they are the larger.
  double scale(bool are_supports_moved, double reaction) const {
    if (step_) return are_supports_moved ? std::max(step_->scale, reaction) : step_->scale;
    return load_norm_ > 0 ? load_norm_ : reaction;
  }

 private:
  std::vector<mechanics::LoadInTime> loads_;
};

} // namespace springproof::fem_reference
