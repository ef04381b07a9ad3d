#pragma once

#include "mechanics/equilibrium/nonlinear_problem.hpp"

namespace springproof::mechanics {

/// Moves `at` along a step as far as the problem's merit allows, shortening the step. Next to the solution an
/// energy's change drowns in rounding: there a falling residual decides.
/// @param residual  at `at`; on success at its new place
/// @param expect    of the full step
/// @return whether a fraction of the step would do; otherwise `at` and `residual` are as they were
bool line_search(NonlinearProblem& problem, Vector& at, Vector& residual, const Vector& step,
                 double load_factor, Expect expect = Expect::residual);

} // namespace springproof::mechanics
