#pragma once

#include "cases/case/case.hpp"
#include "mechanics/equilibrium/find_equilibrium.hpp"

namespace springproof::msm {

/// Equilibrium at full load by one of the explicit iterations that the field uses, for comparison with
/// Newton's method. They see forces alone (L-BFGS the potential too), take equal load steps, by default one,
/// and end in whatever minimum they fall into. Their step lengths come from the largest eigenvalue of the
/// tangent at the start.
///  - force_scaling: x += alpha f (Brown; thesis eq. 2.11), alpha the inverse of that eigenvalue
///  - fire: Bitzek, Koskinen, Gähler, Moseler, Gumbsch, Phys. Rev. Lett. 97, 170201 (2006), their parameters
///  - lbfgs: ten pairs, two-loop recursion (Nocedal 1980), Armijo's rule
/// @param settings  tolerance, first_load_step, max_relaxation_iterations, should_stop, lowest_eigenvalue and
/// stability count
/// @throws cases::SolveError with the residual when the iterations are used up, or they lead nowhere
mechanics::Equilibrium relax(mechanics::NonlinearProblem& problem, const mechanics::Vector& start,
                             cases::Solver method, const mechanics::EquilibriumSettings& settings = {});

} // namespace springproof::msm
