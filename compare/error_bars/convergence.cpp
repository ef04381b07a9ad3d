#include "compare/error_bars/convergence.hpp"

#include "cases/case/elements.hpp"
#include "cases/case/read_case.hpp"
#include "cases/scene/scene.hpp"
#include "compare/measure/measure.hpp"
#include "compare/measure/surfaces.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

using VectorField = std::vector<Eigen::Vector3d>;

constexpr double mesh_ratio = 2;
constexpr double with_order = 1.25, without_order = 3; ///< safety factors on what is left to the limit
constexpr double highest_power = 4;  ///< mesh_ratio to the order 2 of trilinear elements: more is an accident
constexpr double same_order = 0.3;   ///< largest difference of the orders of two steps
constexpr double rounding = 1e-9;    ///< part of a value that a solve leaves undecided
constexpr double above_formal = 0.3; ///< excess of an observed order; more is an accident

/// a + factor (a - b)
VectorField beyond(const VectorField& a, double factor, const VectorField& b) {
  VectorField result(a.size());
  for (std::size_t n = 0; n < a.size(); ++n) result[n] = a[n] + factor * (a[n] - b[n]);
  return result;
}

/// factor (a - b)
VectorField difference(double factor, const VectorField& a, const VectorField& b) {
  VectorField result(a.size());
  for (std::size_t n = 0; n < a.size(); ++n) result[n] = factor * (a[n] - b[n]);
  return result;
}

/// Whether the differences of four values shrink by the same power of the mesh ratio in both steps.
bool is_confirmed(double power, double power_before) {
  return power_before > 1 && std::abs(std::log2(power / power_before)) < same_order;
}

const char* const unconfirmed = "an order that no second step confirms";
const char* const turning = "the values oscillate";

std::string accident(double power, double formal_order) {
  return fmt::format("an order of {:.1f}, which elements of order {:.0f} show by accident", std::log2(power),
                     formal_order);
}

bool is_accident(double power, double formal_order) {
  return power > std::pow(mesh_ratio, formal_order + above_formal);
}

} // namespace

MeshVerdict judge_refinement(const std::vector<double>& coarse_to_fine, double ratio) {
  assert(coarse_to_fine.size() >= 3 && ratio > 1);
  const std::size_t n = coarse_to_fine.size();
  const double f1 = coarse_to_fine[n - 1], f2 = coarse_to_fine[n - 2], f3 = coarse_to_fine[n - 3];
  const double last = f1 - f2, before = f2 - f3;
  if (!std::isfinite(last) || !std::isfinite(before)) return "a value is not finite";
  if (f1 == 0) return "the value is zero, and the error is relative to it";
  const double scale = std::max({std::abs(f1), std::abs(f2), std::abs(f3)});
  if (std::abs(last) <= rounding * scale)
    return fmt::format("the two finest meshes agree to {:.0e}: there is nothing to extrapolate from",
                       rounding);
  if (last * before < 0)
    return fmt::format("the values oscillate: {:.6g}, {:.6g}, {:.6g} from coarse to fine", f3, f2, f1);
  if (!(std::abs(last) < std::abs(before)))
    return fmt::format("the values do not draw nearer: {:.6g}, {:.6g}, {:.6g} from coarse to fine", f3, f2,
                       f1);
  MeshLimit limit{};
  limit.order = std::log(before / last) / std::log(ratio);
  limit.extrapolated = f1 + last / (std::pow(ratio, limit.order) - 1);
  limit.index_percent = discretisation_error_percent(f1, limit);
  return limit;
}

double discretisation_error_percent(double value, const MeshLimit& limit) {
  constexpr double safety_factor = 1.25; // Roache's, for three meshes and more
  return 100 * safety_factor * std::abs((value - limit.extrapolated) / value);
}

std::variant<Limit, std::string> find_limit(const std::vector<double>& coarse_to_fine, double highest_order,
                                            double formal_order) {
  assert(!coarse_to_fine.empty());
  const std::size_t n = coarse_to_fine.size();
  const auto value = [&](std::size_t from_finest) { return coarse_to_fine[n - 1 - from_finest]; };
  const auto change = [&](std::size_t step) { return value(step) - value(step + 1); };
  if (n == 1) return "there is one mesh alone";
  const double last = change(0), least = rounding * std::max(std::abs(value(0)), std::abs(value(1)));
  if (!std::isfinite(last)) return "a value is not finite";
  if (std::abs(last) <= least) return Limit{value(0), least, "the two finest meshes agree"};
  if (n == 2) return Limit{value(0), without_order * std::abs(last), "two meshes, which show no order"};
  const double power = change(1) / last; // mesh ratio to the order; negative when the values oscillate
  if (!(std::abs(power) > 1))
    return fmt::format("the values do not draw nearer: {:.6g}, {:.6g}, {:.6g} from coarse to fine", value(2),
                       value(1), value(0));
  if (power < 0) return Limit{value(0), std::abs(change(1)), turning, true}; // the larger change
  if (is_accident(power, formal_order))
    return Limit{value(0), std::abs(change(1)), accident(power, formal_order), true};
  const double step = last / (std::min(power, std::pow(mesh_ratio, highest_order)) - 1);
  const bool confirmed = n > 3 && is_confirmed(power, change(2) / change(1));
  return Limit{value(0) + step, (confirmed ? with_order : without_order) * std::abs(step),
               confirmed ? "" : unconfirmed};
}

std::variant<FieldLimit, std::string>
find_limit(const std::vector<const std::vector<Eigen::Vector3d>*>& coarse_to_fine, const FieldNorm& norm,
           double formal_order) {
  assert(!coarse_to_fine.empty());
  const std::size_t n = coarse_to_fine.size();
  const auto field = [&](std::size_t from_finest) -> const VectorField& {
    return *coarse_to_fine[n - 1 - from_finest];
  };
  const auto distance = [&](std::size_t a, std::size_t b) { return norm(difference(1, field(a), field(b))); };
  if (n == 1) return "there is one mesh alone";
  const double last = distance(0, 1);
  if (!std::isfinite(last)) return "a value is not finite";
  const VectorField three_changes = difference(without_order, field(0), field(1));
  if (last <= rounding * norm(field(0)))
    return FieldLimit{field(0), three_changes, "the two finest meshes agree"};
  if (n == 2) return FieldLimit{field(0), three_changes, "two meshes, which show no order"};
  // The distances of two meshes to a third, finer one are in the ratio (r^2p - 1)/(r^p - 1) = r^p + 1.
  const double power = distance(0, 2) / last - 1, before = distance(1, 2);
  if (!(last < before))
    return fmt::format(
        "the displacements do not draw nearer to each other: they change by {:.4g} and {:.4g} mm in "
        "the mean over the last meshes",
        before, last);
  if (!(power > 1) || is_accident(power, formal_order))
    return FieldLimit{field(0), difference(1, field(1), field(2)),
                      power > 1 ? accident(power, formal_order) : turning, true};
  const bool confirmed = n > 3 && is_confirmed(power, distance(1, 3) / distance(1, 2) - 1);
  const double part = 1 / (std::min(power, highest_power) - 1);
  return FieldLimit{beyond(field(0), part, field(1)),
                    difference((confirmed ? with_order : without_order) * part, field(0), field(1)),
                    confirmed ? "" : unconfirmed};
}

namespace {

/// The order and the error bar of the finite elements on the case's own mesh.
void find_order(StudiedMeasure& studied, std::size_t own, double formal_order) {
  if (studied.values.size() < 3) {
    studied.reason = "fewer than three meshes show no order";
    return;
  }
  const MeshVerdict verdict = judge_refinement(studied.values, mesh_ratio);
  if (const auto* limit = std::get_if<MeshLimit>(&verdict)) {
    if (const double power = std::pow(mesh_ratio, limit->order); is_accident(power, formal_order)) {
      studied.reason = accident(power, formal_order);
      return;
    }
    studied.limit = *limit;
    studied.discretisation_error_percent = discretisation_error_percent(studied.values[own], *limit);
  } else {
    studied.reason = std::get<std::string>(verdict);
  }
}

/// Each mesh's norm is that of its own field, of which the body's nodes show a part: the limit is that of
/// these values, and is uncertain by what they are and by what the field at the nodes is.
void find_reference(StudiedMeasure& studied, const cases::measures::Kind& kind, const FieldNorm& norm,
                    const std::variant<FieldLimit, std::string>& field, double formal_order) {
  auto limit = find_limit(studied.values, 2, formal_order);
  const auto* of_field = std::get_if<FieldLimit>(&field);
  if (is_field_norm(kind) &&
      of_field == nullptr) { // its own values may show an order that the field does not have
    limit = std::get<std::string>(field);
    studied.reason = std::get<std::string>(field);
    studied.limit.reset();
    studied.discretisation_error_percent.reset();
  }
  if (const auto* reason = std::get_if<std::string>(&limit)) {
    studied.no_reference = *reason;
    return;
  }
  studied.reference = std::get<Limit>(limit);
  if (!is_field_norm(kind)) return;
  studied.reference->uncertainty = std::max(studied.reference->uncertainty, norm(of_field->uncertainty));
  studied.reference->turns = studied.reference->turns || of_field->turns;
  if (!of_field->note.empty()) studied.reference->note = of_field->note;
}

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

MeshStudy study_meshes(const cases::Scene& scene, const RefinedMeshes& meshes, int own_refine) {
  const double order = cases::facts_of(scene.definition.fem.element).order;
  MeshStudy study;
  study.refine = meshes.refine;
  std::vector<const VectorField*> fields;
  for (const cases::Solution& solution : meshes.solutions) {
    study.unknowns.push_back(solution.unknowns);
    fields.push_back(&solution.displacement);
  }
  const cases::Sharing* const sharing =
      meshes.solutions.empty() ? nullptr : meshes.solutions[0].sharing.get();
  const auto norm_of = [&](const cases::measures::Kind& kind) -> FieldNorm {
    return [&, kind](const VectorField& on_nodes) { return field_norm(kind, scene.mesh, on_nodes, sharing); };
  };
  std::variant<FieldLimit, std::string> field = meshes.reason;
  const auto& measures = scene.definition.measures;
  if (!fields.empty() && std::any_of(measures.begin(), measures.end(),
                                     [](const cases::Measure& m) { return is_field_norm(m.kind); }))
    field = find_limit(fields, norm_of(cases::measures::DisplacementFieldL2{}), order);
  for (const cases::Measure& measure : measures) {
    StudiedMeasure& studied = study.measures.emplace_back();
    studied.name = measure.name;
    bool is_everywhere = true;
    for (const cases::Solution& solution : meshes.solutions) {
      const std::optional<double> value = value_of(measure, scene, solution);
      is_everywhere = is_everywhere && value;
      studied.values.push_back(value.value_or(0));
    }
    if (!is_everywhere) studied.values.clear();
    if (studied.values.empty()) {
      studied.reason = studied.no_reference =
          is_everywhere ? meshes.reason : "its course over time has no such number on some mesh";
      continue;
    }
    find_order(studied, cases::index(own_refine - meshes.refine.front()), order);
    find_reference(studied, measure.kind, norm_of(measure.kind), field, order);
  }
  if (auto* found = std::get_if<FieldLimit>(&field)) study.field = std::move(*found);
  return study;
}

std::vector<MeasuredValue> measure(const cases::Scene& scene, const Answers& answers,
                                   const MeshStudy* study) {
  std::vector<MeasuredValue> values;
  for (const cases::Measure& measure : scene.definition.measures) {
    MeasuredValue value{measure.name, unit_of(measure), {}, {}, {}};
    const auto value_by = [&](const Answer& answer, std::string& reason) -> std::optional<double> {
      if (!answer.converged()) return std::nullopt;
      const auto found = finite_value(measure, scene, answer.solution);
      if (const auto* number = std::get_if<double>(&found)) return *number;
      reason = std::get<std::string>(found);
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
