#pragma once

#include "cases/scene/scene.hpp"
#include "compare/solve/answers.hpp"

namespace springproof::compare {

/// Why this scene has no continuum limit, if it has none: the displacement under forces on points or edges
/// grows without bound as the mesh is refined.
std::optional<std::string> reason_without_continuum_limit(const cases::Scene& scene);

/// The scene with another [fem], such as the one that "auto" was found to mean.
cases::Scene with_fem(cases::Scene scene, const cases::Fem& fem);

/// Solves the finite elements on n_meshes meshes, from the body's own on, or on the finest of them around the
/// case's own when that is refined further. Nothing is solved when there is no continuum limit. A solve that
/// fails leaves its reason alone. Collective over MPI_COMM_WORLD.
/// @param own       the solution at the scene's own refinement, used again
/// @param n_meshes  at least 3
RefinedMeshes solve_refined(const cases::Scene& scene, const cases::Solution& own, int n_meshes);

} // namespace springproof::compare
