#include "compare/error_bars/measured_values.hpp"

#include "cases/case/read_case.hpp"
#include "compare/measure/measure.hpp"
#include "compare/measure/surfaces.hpp"

#include <cmath>

namespace springproof::compare {

namespace {

/// Errors against the limit, in place of those against the same mesh.
void hold_against_limit(MeasuredValue& value, const cases::Measure& measure, const cases::Scene& scene,
                        const Answers& answers, const MeshStudy& study) {
  const Limit& limit = value.fem_limit.value();
  const auto error_of = [&](const Answer& answer,
                            const std::optional<double>& of_side) -> std::optional<double> {
    if (!of_side) return std::nullopt;
    const double zero = zero_of(measure, scene, answers.fem.solution);
    if (!is_field_norm(measure.kind)) return error_percent(limit.value, *of_side, zero);
    return field_error_percent(measure.kind, scene.mesh, study.field->value, answer.solution.displacement,
                               zero, answer.solution.sharing.get());
  };
  value.error_percent = error_of(answers.msm, value.msm);
  value.fem_error_percent = error_of(answers.fem, value.fem);
  if (!value.error_percent) return;
  const double part = 100 * limit.uncertainty / std::abs(limit.value);
  // A change d of the limit changes r = 100 (m/f - 1) by (100 + r) d/f, and a difference of fields by d.
  value.error_uncertainty_percent =
      is_field_norm(measure.kind) ? part : part * std::abs(1 + *value.error_percent / 100);
}

/// Adds how much the finite elements' value changes on the way to the results' mesh and back.
void add_interpolation_error(MeasuredValue& value, const cases::Measure& measure, const cases::Scene& scene,
                             const Answers& answers) {
  const cases::Solution &fem = answers.fem.solution, &back = answers.interpolated->fem_and_back.solution;
  if (is_field_norm(measure.kind)) {
    std::vector<Eigen::Vector3d> change;
    for (std::size_t n = 0; n < fem.displacement.size(); ++n)
      change.push_back(back.displacement[n] - fem.displacement[n]);
    value.interpolation_error = field_norm(measure.kind, scene.mesh, change, fem.sharing.get());
  } else {
    value.interpolation_error = std::abs(evaluate(measure, scene, back) - evaluate(measure, scene, fem));
  }
  if (const auto percent = measure_error_percent(measure, scene, fem, back))
    value.interpolation_error_percent = std::abs(*percent);
}

/// Measures the surface that a dynamic case names, over the time of the written bodies.
MeasuredValue surface_over_time(const cases::Scene& scene, const Answers& answers) {
  MeasuredValue value{cases::surface_measure, "mm", {}, {}, {}};
  const auto motion = surface_motion(scene, answers);
  if (!motion) return value;
  value.fem = value_over_time(cases::OverTime::trajectory_l2, {motion->time, motion->fem});
  value.msm = value_over_time(cases::OverTime::trajectory_l2, {motion->time, motion->msm});
  value.error_percent = value.error_same_mesh_percent = motion->error_percent;
  return value;
}

} // namespace

std::vector<MeasuredValue> measure(const cases::Scene& scene, const Answers& answers,
                                   const MeshStudy* study) {
  std::vector<MeasuredValue> values;
  for (const cases::Measure& measure : scene.definition.measures) {
    MeasuredValue value{measure.name, unit_of(measure), {}, {}, {}};
    const auto value_by = [&](const Answer& answer, std::string& reason) -> std::optional<double> {
      if (!answer.converged()) return std::nullopt;
      if (can_evaluate(measure, answer.solution))
        if (const auto found = value_of(measure, scene, answer.solution); found && std::isfinite(*found))
          return found;
      reason = why_without_value(measure, scene, answer.solution);
      return std::nullopt;
    };
    value.fem = value_by(answers.fem, value.fem_reason);
    value.msm = value_by(answers.msm, value.msm_reason);
    std::string unused;
    if (answers.peer) value.peer = value_by(answers.peer->answer, unused);
    if (value.fem && value.msm)
      value.error_same_mesh_percent =
          measure_error_percent(measure, scene, answers.fem.solution, answers.msm.solution);
    value.error_percent = value.error_same_mesh_percent;
    // The limit of a motion's norm is one number, but the error would be the whole course's.
    const bool is_studied = study && !is_trajectory_norm(measure);
    const StudiedMeasure* studied = is_studied ? find_named(study->measures, measure.name) : nullptr;
    if (studied && studied->reference) {
      value.fem_limit = studied->reference;
      hold_against_limit(value, measure, scene, answers, *study);
    }
    if (answers.interpolated && answers.fem.converged())
      add_interpolation_error(value, measure, scene, answers);
    values.push_back(value);
  }
  if (scene.definition.surface && scene.definition.dynamics)
    values.push_back(surface_over_time(scene, answers));
  return values;
}

} // namespace springproof::compare
