#pragma once

#include "cases/scene/scene.hpp"
#include "compare/solve/answers.hpp"

namespace springproof::compare {

/// The finite elements' answer, and the [fem] that it is the answer to.
struct FemAnswer {
  Answer answer;
  cases::Fem resolved;
  std::vector<std::string> choices; ///< a line for everything that was chosen, with the reason and the cost
};

/// How the finite elements' side is solved: solve_fem() of compare/error_bars, which knows how to find what
/// "auto" in [fem] leaves open, or solve_fem_as_given().
using SolveFem = FemAnswer (*)(const cases::Scene& scene);

/// With the formulation and refinement of the scene's definition as they are. Collective over MPI_COMM_WORLD.
FemAnswer solve_fem_as_given(const cases::Scene& scene);

/// Solves both sides of a case, or the one asked for, and the refined meshes if asked for. A solve that fails
/// is a failed side. Collective over MPI_COMM_WORLD; the mass-spring side is solved on rank 0 alone.
/// @throws InputError
Answers solve(const cases::Scene& scene, const Request& request, SolveFem solve_fem);

} // namespace springproof::compare
