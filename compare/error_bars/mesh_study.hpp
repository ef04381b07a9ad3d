#pragma once

#include "cases/case/solution.hpp"
#include "cases/scene/scene.hpp"
#include "compare/error_bars/convergence.hpp"

#include <optional>
#include <string>
#include <vector>

namespace springproof::compare {

/// One measure on the meshes of a study.
struct StudiedMeasure {
  std::string name;
  std::vector<double> values;     ///< from coarse to fine, in the measure's unit
  std::optional<MeshLimit> limit; ///< absent when there is none to be seen
  /// Error bar of the finite elements' value on the case's own mesh; absent with the limit.
  std::optional<double> discretisation_error_percent;
  std::string reason; ///< why there is no limit; empty when there is one
};

/// The finite elements' own error, from the same case on uniformly refined meshes.
struct MeshStudy {
  std::vector<int> refine; ///< refinements of the body's mesh, ascending
  std::vector<std::size_t> unknowns;
  std::vector<StudiedMeasure>
      measures; ///< all of the case's, in its order; without values when nothing was solved
};

/// Why refining the mesh of this scene leads nowhere, if it does not: forces on points or edges have no
/// continuum limit, because the displacement under them grows without bound (thesis.md section 7 says which
/// cases).
std::optional<std::string> reason_without_continuum_limit(const cases::Scene& scene);

/// Solves the finite elements on n_meshes meshes, from the body's own on, or on the finest of them around the
/// case's own when that is refined further. Nothing is solved when there is no continuum limit. A solve that
/// fails leaves its reason with every measure. Collective over MPI_COMM_WORLD.
/// @param own       the solution at the case's own refinement, used again
/// @param n_meshes  at least 3
MeshStudy study_meshes(const cases::Scene& scene, const cases::Solution& own, int n_meshes);

} // namespace springproof::compare
