#pragma once

#include "compare/solve/answers.hpp"

namespace springproof::compare {

/// Value of a measure on a converged solution, in unit_of(measure).
///   coordinate, displacement: of the node; tilt: atan2(d_toward, d_up) of the vector from bottom to top;
///   twist: rotation of the segment from centre to node about the axis against its rest direction, in (-180,
///   180]; volume: of all cells of the body's mesh; displacement_field_l2: root of the mean of |u|² over the
///   body at rest (trilinear between nodes); displacement_field_max: the largest |u| of a node.
/// Source: thesis sections 4.3.3 and 5.3.1.3 but for the two norms.
double evaluate(const cases::Measure& measure, const cases::Scene& scene, const cases::Solution& solution);

/// Error of the springs in a measure, percent. For a field norm that of the difference of both fields over
/// that of the finite elements', never negative; otherwise error_percent() of the two values.
std::optional<double> measure_error_percent(const cases::Measure& measure, const cases::Scene& scene,
                                            const cases::Solution& fem, const cases::Solution& msm);

/// Whether a measure's error is that of a difference of fields.
bool is_field_norm(cases::MeasureKind kind);

/// "mm", "deg" or "mm3".
std::string unit_of(const cases::Measure& measure);

/// r = (msm - fem)/fem x 100 %, as in the thesis; nothing when fem is zero next to msm or either is not
/// finite.
std::optional<double> error_percent(double fem, double msm);

/// A measure on both sides. A side that failed or was skipped has no value.
struct MeasuredValue {
  std::string name, unit;
  std::optional<double> fem, msm, error_percent;
  std::optional<double> peer = std::nullopt; ///< by another program, when it was asked
};

/// What has that name, or null.
template<class Named>
const Named* find_named(const std::vector<Named>& all, const std::string& name) {
  for (const Named& one : all)
    if (one.name == name) return &one;
  return nullptr;
}

/// All measures of a case, in its order.
std::vector<MeasuredValue> measure(const cases::Scene& scene, const Answers& answers);

} // namespace springproof::compare
