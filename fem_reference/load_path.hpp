#pragma once

#include "fem_reference/equilibrium.hpp"
#include "fem_reference/linear_solver.hpp"

#include <string>

namespace springproof::fem_reference {

constexpr double volume_tolerance = 1e-12; ///< relative volume of a cell's condensed pressure

struct NewtonReport {
  bool converged = false;
  std::string failure; ///< why not
  int iterations = 0;
  long linear_iterations = 0;
  double residual = 0;
};

/// What is asked of every load step, and how far one goes.
struct LoadSteps {
  double from = 0, to = 1;  ///< load factors; the state given is in equilibrium at the first
  double largest = 1;       ///< of the way from one to the other
  double tolerance = 1e-10; ///< on |imbalance| / |applied load|
};

/// Newton's method with a line search at one load factor, from the state given, which it changes. Never more
/// than a fixed number of iterations.
NewtonReport newton(Equilibrium& equilibrium, LinearSolver& solver, State& state, double load_factor,
                    double tolerance);

/// From one load to another. The first step is the largest allowed; a step that fails is halved, one that
/// converges easily is doubled, and a step starts from the last increment extrapolated.
/// @throws SolveError when the step gets too small or the iterations too many
NewtonReport carry_load(Equilibrium& equilibrium, LinearSolver& solver, State& state,
                        const LoadSteps& steps = {});

} // namespace springproof::fem_reference
