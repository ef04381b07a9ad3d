#pragma once

#include "cases/scene/scene.hpp"
#include "compare/solve/answers.hpp"
#include "mechanics/equilibrium/find_equilibrium.hpp"

namespace springproof::compare {

/// A solver's settings with the limits of a hard case: load steps, iterations, seconds from now on. For
/// another case they stay as they are.
mechanics::EquilibriumSettings limited(const cases::Case& definition,
                                       mechanics::EquilibriumSettings settings = {});

/// Designs the springs of a scene and solves them in this process, which needs no finite elements: those of a
/// hard case stiffer where it says so and from where it starts.
/// @param n_threads  of the multigrid path    @param design  absent: the caller is not told
/// @throws InputError when no springs can be designed
Answer solve_springs(const cases::Scene& scene, int n_threads, std::optional<msm::DesignResult>& design);

} // namespace springproof::compare
