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

/// What force scaling comes to after a given number of iterations, in equilibrium or not: the load grows in
/// equal steps, each followed by iterations that start from where the last ones left the free points, and
/// more iterations follow the last one. So moves San-Vicente's Maxiplan (thesis section 6.1.4.2: 10 steps of
/// 30, then 2,000). alpha is the inverse of the largest eigenvalue of the tangent at the start.
/// @param settings  tolerance and should_stop count
/// @return the solution, with the residual that is left
/// @throws cases::SolveError when a force is not finite, or it was stopped
mechanics::Equilibrium relax_for(mechanics::NonlinearProblem& problem, const mechanics::Vector& start,
                                 const cases::RelaxationCounts& counts,
                                 const mechanics::EquilibriumSettings& settings = {});

} // namespace springproof::msm
