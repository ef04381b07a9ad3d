#pragma once

#include "compare/error_bars/mesh_study.hpp"

namespace springproof::compare {

/// A measure on both sides. A side that failed or was skipped has no value; values are finite.
///
/// The reference is the limit of the finite elements under refinement where the case has one and its study
/// shows it, else the finite elements on the case's own mesh. Errors are (value - reference)/reference; a
/// field norm's is taken of the difference of the fields, and never negative.
struct MeasuredValue {
  std::string name, unit;
  std::optional<double> fem, msm;      ///< in the unit
  std::optional<double> error_percent; ///< springs against the reference
  std::optional<double> peer{};        ///< another program's value, when it was asked
  std::optional<Limit> fem_limit{};    ///< the reference, in the unit; absent: the same mesh is the reference
  std::optional<double> error_uncertainty_percent{}; ///< points, left by the limit; absent without it
  std::optional<double> error_same_mesh_percent{};   ///< springs against the finite elements' value
  std::optional<double> fem_error_percent{}; ///< finite elements' value against the limit; absent without it
  /// Estimate of what interpolation from another mesh adds to the springs' value, in the unit, and to their
  /// error, points; for a field norm, the norm of that field. Absent where nothing was interpolated.
  std::optional<double> interpolation_error{}, interpolation_error_percent{};
  /// Why a side that has an answer has no value, such as a frequency of what does not swing; empty: it has
  /// one.
  std::string fem_reason{}, msm_reason{};
};

/// All measures of a case, in its order; after them, of a dynamic case with [surface], that surface's
/// (cases::surface_measure), without values unless both models moved to the end.
/// @param study  study of the same case; null: there is none
std::vector<MeasuredValue> measure(const cases::Scene& scene, const Answers& answers, const MeshStudy* study);

} // namespace springproof::compare
