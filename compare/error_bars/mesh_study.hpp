#pragma once

#include "cases/scene/scene.hpp"
#include "compare/error_bars/convergence.hpp"
#include "compare/solve/answers.hpp"

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

/// What the answers on refined meshes tell of the finite elements' own error, measure by measure.
/// @param answers  with refined meshes
MeshStudy study_meshes(const cases::Scene& scene, const Answers& answers);

} // namespace springproof::compare
