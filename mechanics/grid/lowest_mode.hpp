#pragma once

#include "mechanics/equilibrium/nonlinear_problem.hpp"

#include <functional>

namespace springproof::mechanics::grid {

/// A symmetric operator, and what is needed to find its lowest mode.
struct ModeProblem {
  std::function<void(const Vector& in, Vector& out)> product;
  std::function<void(const Vector& in, Vector& out)> precondition; ///< an inverse, more or less
  std::function<double(const Vector&, const Vector&)> dot;
  int n_threads = 1;
  double settled =
      1e-4; ///< relative change of the eigenvalue, from one iteration to the next, that ends them
};

/// Finds the lowest eigenvalue and its eigenvector by LOBPCG with one vector (Knyazev 2001).
/// @param start  the first vector is its preconditioned image; needs a part in every mode
/// @return nothing if the eigenvalue is not finite: then it is lost in rounding
std::optional<NonlinearProblem::Mode> lowest_mode(const ModeProblem& problem, const Vector& start);

} // namespace springproof::mechanics::grid
