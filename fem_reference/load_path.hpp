#pragma once

#include "fem_reference/equilibrium.hpp"
#include "fem_reference/linear_solver.hpp"

#include <string>

namespace fem_reference {

constexpr double residual_tolerance = 1e-10; ///< |imbalance| / |applied load| asked of every load step
constexpr double volume_tolerance = 1e-12;   ///< relative volume of a cell's condensed pressure

struct NewtonReport {
  bool converged = false;
  std::string failure; ///< why not
  int iterations = 0;
  long linear_iterations = 0;
  double residual = 0;
};

/// Newton's method with a line search at one load factor, from the state given, which it changes. Never more
/// than a fixed number of iterations.
NewtonReport newton(Equilibrium& equilibrium, LinearSolver& solver, State& state, double load_factor);

/// From rest to the full load. The first step is the largest allowed; a step that fails is halved, one that
/// converges easily is doubled, and a step starts from the last increment extrapolated.
/// @param largest_step  of the full load
/// @throws SolveError when the step gets too small or the iterations too many
NewtonReport carry_load(Equilibrium& equilibrium, LinearSolver& solver, State& state,
                        double largest_step = 1);

} // namespace fem_reference
