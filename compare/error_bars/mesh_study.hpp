#pragma once

#include "cases/scene/scene.hpp"
#include "compare/solve/answers.hpp"

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace springproof::compare {

/// What a quantity's values on a sequence of uniformly refined meshes tell of its limit.
struct MeshLimit {
  double order;         ///< observed: p = ln((f3 - f2)/(f2 - f1)) / ln r, f1 on the finest mesh
  double extrapolated;  ///< Richardson: f0 = f1 + (f1 - f2)/(r^p - 1), in the quantity's unit
  double index_percent; ///< grid convergence index of the finest mesh: 1.25 |(f1 - f2)/f1| / (r^p - 1) x 100
};

/// The limit, or why there is none.
using MeshVerdict = std::variant<MeshLimit, std::string>;

/// Judges the three finest values of a sequence.
/// @param coarse_to_fine  three or more values, each mesh refined from the one before
/// @param ratio           of mesh widths, > 1
/// @return a reason instead of a limit if a value is not finite, if the values oscillate or do not draw
/// nearer to each other, if they agree to `resolved` of their size (there is nothing left to extrapolate), or
/// if the finest is zero Source: P. J. Roache, Perspective: a method for uniform reporting of grid refinement
/// studies, J. Fluids Eng. 116 (1994).
MeshVerdict judge_refinement(const std::vector<double>& coarse_to_fine, double ratio, double resolved = 1e-9);

/// Error bar of a value on any of the meshes: 1.25 |(f - f0)/f| x 100, which on the finest is the grid
/// convergence index.
double discretisation_error_percent(double value, const MeshLimit& limit);

/// Error bar of the finest value, percent, from two meshes or more: the grid convergence index where three
/// show a limit, else Roache's bar for two meshes, 3 |(f1 - f2)/f1| x 100, with order 1, the least that a
/// boundary's edges leave. Infinite when the finest value is zero or not finite.
double finest_error_percent(const std::vector<double>& coarse_to_fine, double ratio);

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
