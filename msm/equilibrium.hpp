#pragma once

#include "msm/tangent.hpp"

#include <memory>

namespace msm {

/// A lattice that is held and loaded.
struct Problem {
  Lattice lattice;
  Points force;               ///< applied at full load, N, one per point
  std::vector<bool> is_fixed; ///< degree of freedom 3*point + component stays at rest
};

struct EquilibriumSettings {
  double tolerance = 1e-9;      ///< on |imbalance on free degrees of freedom| / |applied load|
  int max_newton_per_step = 40; ///< more than twice what any load step that succeeded was seen to need
  int max_load_steps = 400;
  double smallest_load_step = 1e-4; ///< of the full load; a step below it means a limit point or a mechanism
};

struct Equilibrium {
  Points positions; ///< mm
  double residual = 0;
  double load_reached = 0;
  int newton_iterations = 0;
  int factorisations = 0;
  int clamped_factorisations = 0; ///< of these, how many needed the clamp
};

/// Static equilibrium of a lattice by Newton's method with the exact sparse tangent (CHOLMOD), an energy line
/// search and load steps that adapt. The tangent is clamped only when the exact one is not positive definite.
class EquilibriumSolver {
 public:
  /// Finds the pattern and orders it. @param problem  must outlive the solver
  EquilibriumSolver(const Problem& problem, const EquilibriumSettings& settings = {});
  ~EquilibriumSolver();

  /// Equilibrium at full load. @param start  positions to start from, at load 0
  /// @throws cases::SolveError with the load reached
  Equilibrium solve(const Points& start);

  int n_free() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

} // namespace msm
