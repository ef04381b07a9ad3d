#pragma once

#include "compare/gates/comparison.hpp"

#include <string>

using namespace springproof;

/// Comparisons made by hand: a unit cube with one measure "L" and what is expected of it.
namespace judged {

inline cases::Expectation expectation(cases::Quantity quantity, std::array<double, 2> interval,
                                      cases::ReferenceKind kind = cases::ReferenceKind::published) {
  return {"L", quantity, interval, kind, "because", {"cube.toml", 12, 1, "expect[0]"}};
}

/// Both sides converged; fem = 10 mm, msm = 9 mm, so that the error is -10 %.
inline compare::Comparison comparison(const std::vector<cases::Expectation>& expectations) {
  compare::Comparison result;
  cases::Case& definition = result.scene.definition;
  definition.name = "cube";
  definition.file = "cube.toml";
  definition.expectations = expectations;
  definition.measures = {{"L", cases::measures::Coordinate{}}};
  result.answers.fem.solution.status = result.answers.msm.solution.status = cases::Status::converged;
  result.measures = {{"L", "mm", 10.0, 9.0, -10.0}};
  return result;
}

/// Adds the finite elements' own error bar, a percentage of their value.
inline compare::Comparison studied(compare::Comparison result, double percent) {
  result.mesh_study = compare::MeshStudy{};
  result.mesh_study->refine = {0, 1, 2};
  result.mesh_study->unknowns = {100, 1000, 10000};
  result.mesh_study->measures = {{"L", {}, compare::MeshLimit{1, 10, percent}, percent, ""}};
  return result;
}

/// Adds a limit of 10 mm, known to a percentage; the error of -10 % is relative to it.
inline compare::Comparison with_limit(compare::Comparison result, double percent) {
  result = studied(std::move(result), percent);
  result.mesh_study->measures[0].reference = compare::Limit{10, percent / 10, ""};
  result.measures[0].fem_limit = result.mesh_study->measures[0].reference;
  result.measures[0].error_uncertainty_percent = 0.9 * percent; // msm is 9/10 of the limit
  return result;
}

/// The gates of a comparison that was made by hand.
inline compare::Comparison judge(compare::Comparison comparison) {
  comparison.gates = compare::judge(comparison.scene, comparison.answers, comparison.measures,
                                    comparison.mesh_study ? &*comparison.mesh_study : nullptr);
  return comparison;
}

} // namespace judged
