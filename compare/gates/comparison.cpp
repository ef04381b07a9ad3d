#include "compare/gates/comparison.hpp"

#include "cases/case/names.hpp"
#include "compare/error_bars/auto_fem.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

using cases::Quantity;

/// "fem failed at 0.25 of the load: REASON"
std::string describe_failure(const char* side, const cases::Solution& solution) {
  return fmt::format("{} failed at {:.4g} of the load: {}", side, solution.load_reached, solution.message);
}

/// The sides that a quantity is of.
std::vector<std::pair<const char*, const Answer*>> sides_of(const Answers& answers, Quantity quantity) {
  std::vector<std::pair<const char*, const Answer*>> sides;
  if (quantity != Quantity::msm) sides.emplace_back("fem", &answers.fem);
  if (quantity != Quantity::fem) sides.emplace_back("msm", &answers.msm);
  return sides;
}

/// Why a measure that is there has no value, and whether that is because a side was not asked for.
void explain(Gate& gate, const Answers& answers, const MeasuredValue& measured) {
  const auto add = [&gate](const std::string& reason) {
    if (!reason.empty()) gate.cause += (gate.cause.empty() ? "" : "; ") + reason;
  };
  const Quantity quantity = gate.expectation.quantity;
  bool is_at_fault = false;
  for (const auto& [side, answer] : sides_of(answers, quantity)) {
    const cases::Solution& solution = answer->solution;
    if (solution.status == cases::Status::skipped) {
      gate.is_left_out = true;
      add(fmt::format("{} was not asked for", side));
      continue;
    }
    const std::string& reason = answer == &answers.fem ? measured.fem_reason : measured.msm_reason;
    is_at_fault = is_at_fault || !answer->converged() || !reason.empty();
    if (!answer->converged())
      add(describe_failure(side, solution));
    else if (!reason.empty())
      add(fmt::format("{}: {}", side, reason));
  }
  gate.is_left_out = gate.is_left_out && !is_at_fault;
  if (!gate.cause.empty()) return;
  gate.cause = quantity == Quantity::error_percent
                   ? "the reference is zero, or a value is not finite: there is no percentage; expect an "
                     "interval of msm or fem"
                   : "it has no finite value";
}

bool needs_limit(const cases::Expectation& expected) {
  return expected.reference == cases::ReferenceKind::converged;
}

/// Whether an interval has to hold for all that the value may be, where a limit is known.
bool holds_for_all(const cases::Expectation& expected) {
  return needs_limit(expected) || expected.reference == cases::ReferenceKind::requirement;
}

std::optional<double> value_of(const cases::Expectation& expected, const MeasuredValue& measured) {
  switch (expected.quantity) {
  case Quantity::error_percent:
    return measured.error_percent;
  case Quantity::msm:
    return measured.msm;
  case Quantity::fem:
    return needs_limit(expected) && measured.fem_limit ? measured.fem_limit->value : measured.fem;
  }
  return std::nullopt;
}

/// Adds those that are there; nothing if none is.
std::optional<double> sum(const std::optional<double>& a, const std::optional<double>& b) {
  return a && b ? *a + *b : a ? a : b;
}

/// Whether a quantity depends on the side that was interpolated.
bool is_interpolated(const Answers& answers, Quantity quantity) {
  return answers.interpolated &&
         quantity != (answers.interpolated->side == cases::Side::fem ? Quantity::msm : Quantity::fem);
}

/// Returns the uncertainty of the value, in the gate's unit. An error bar of d percent on the finite
/// elements' value f is d f/100.
std::optional<double> uncertainty(const cases::Expectation& expected, const MeasuredValue& measured,
                                  const StudiedMeasure* study, bool is_interpolated) {
  const auto with = [&](const std::optional<double>& error, const std::optional<double>& interpolation) {
    return is_interpolated ? sum(error, interpolation) : error;
  };
  switch (expected.quantity) {
  case Quantity::error_percent:
    return with(measured.error_uncertainty_percent, measured.interpolation_error_percent);
  case Quantity::msm:
    return with({}, measured.interpolation_error);
  case Quantity::fem:
    if (needs_limit(expected) && measured.fem_limit)
      return with(measured.fem_limit->uncertainty, measured.interpolation_error);
    if (!study || !study->discretisation_error_percent || !measured.fem)
      return with({}, measured.interpolation_error);
    return with(*study->discretisation_error_percent / 100 * std::abs(*measured.fem),
                measured.interpolation_error);
  }
  return std::nullopt;
}

/// What would decide a gate that the reference's uncertainty leaves open.
std::string what_decides(const MeshStudy& study) {
  return fmt::format("a finer reference decides it: --converge={} (a mesh of about {:.2g} unknowns)",
                     study.refine.size() + 1, 8. * static_cast<double>(study.unknowns.back()));
}

/// The interval has to hold for all that the value may be.
/// @param decides  what would decide a gate that is open
void judge_with_uncertainty(Gate& gate, const std::string& decides) {
  const auto& [lower, upper] = gate.expectation.interval;
  const double least = *gate.value - *gate.uncertainty, most = *gate.value + *gate.uncertainty;
  if (lower <= least && most <= upper) return; // met
  gate.is_undecided = least <= upper && lower <= most;
  if (gate.is_undecided)
    gate.missed = fmt::format("undecided: {:.6g} +- {:.2g} is partly outside [{:.6g}, {:.6g}]; {}",
                              *gate.value, *gate.uncertainty, lower, upper, decides);
}

/// What is expected of a converged reference is not met without one, the springs' own value neither. Without
/// finite elements nobody could look for it.
void miss_without_limit(Gate& gate, const Answers& answers, const StudiedMeasure* studied) {
  gate.is_left_out = gate.met() && answers.fem.solution.status == cases::Status::skipped;
  gate.missed = "there is no converged reference: " + (gate.is_left_out ? "fem was not asked for"
                                                       : studied        ? studied->no_reference
                                                                        : "no mesh study was made");
}

std::string warning_of(const Gate& gate) {
  const cases::Expectation& expected = gate.expectation;
  const double width = expected.interval[1] - expected.interval[0];
  if (gate.uncertainty && !(width >= 2 * *gate.uncertainty))
    return fmt::format("the interval is narrower than the {}'s own error bar, +- {:.2g} {}", gate.uncertain,
                       *gate.uncertainty, gate.unit);
  return "";
}

/// Judges by what was measured alone. The finite elements' value of a converged reference is their limit.
/// @param found  what was measured; null: there is no such measure
Gate judge(const cases::Expectation& expectation, const MeasuredValue* found) {
  if (!found) return {expectation, std::nullopt, "there is no such measure"};
  const std::optional<double> value = value_of(expectation, *found);
  if (!value) return {expectation, value, "it has no value: a side failed or was not solved"};
  if (!std::isfinite(*value)) return {expectation, std::nullopt, "it is not a finite number"};
  const auto& [lower, upper] = expectation.interval;
  if (lower <= *value && *value <= upper) return {expectation, value};
  return {expectation, value, fmt::format("{:.6g} is outside [{:.6g}, {:.6g}]", *value, lower, upper)};
}

} // namespace

std::vector<Gate> judge(const cases::Scene& scene, const Answers& answers,
                        const std::vector<MeasuredValue>& measures, const MeshStudy* study) {
  std::vector<Gate> gates;
  for (const cases::Expectation& expected : scene.definition.expectations) {
    const cases::Measure* measure = find_named(scene.definition.measures, expected.measure);
    const MeasuredValue* measured = find_named(measures, expected.measure);
    const StudiedMeasure* studied = study ? find_named(study->measures, expected.measure) : nullptr;
    Gate gate = judge(expected, measured);
    const std::string unit = measure ? unit_of(*measure) : measured ? measured->unit : "";
    gate.unit = expected.quantity == Quantity::error_percent ? "%" : unit;
    if (!gate.met() && !gate.value && measured) explain(gate, answers, *measured);
    const bool of_interpolated = is_interpolated(answers, expected.quantity);
    if (measured && gate.value) gate.uncertainty = uncertainty(expected, *measured, studied, of_interpolated);
    if (of_interpolated && measured && measured->interpolation_error)
      gate.uncertain = measured->error_uncertainty_percent && expected.quantity == Quantity::error_percent
                           ? "reference and interpolation"
                           : "interpolation";
    const bool is_of_limit = holds_for_all(expected) && expected.quantity != Quantity::msm;
    if (needs_limit(expected) && gate.value && !measured->fem_limit)
      miss_without_limit(gate, answers, studied);
    else if ((is_of_limit || of_interpolated) && gate.value && gate.uncertainty)
      judge_with_uncertainty(gate, is_of_limit && study
                                       ? what_decides(*study)
                                       : "results on the case's own mesh, or on finer meshes, decide it");
    gate.warning = warning_of(gate);
    gates.push_back(gate);
  }
  return gates;
}

Comparison comparison_of(cases::Scene scene, Answers answers) {
  Comparison comparison;
  if (answers.refined) comparison.mesh_study = study_meshes(scene, *answers.refined, answers.resolved.refine);
  const MeshStudy* study = comparison.mesh_study ? &*comparison.mesh_study : nullptr;
  comparison.measures = measure(scene, answers, study);
  comparison.gates = judge(scene, answers, comparison.measures, study);
  comparison.landmarks = landmark_distances(scene, answers);
  comparison.surface_motion = surface_motion(scene, answers);
  comparison.scene = std::move(scene);
  comparison.answers = std::move(answers);
  return comparison;
}

Comparison compare_case(const cases::Case& definition, const Request& request) {
  cases::Scene scene = cases::make_scene(definition);
  Answers answers = solve(scene, request, solve_fem);
  return comparison_of(std::move(scene), std::move(answers));
}

std::vector<std::string> Comparison::doubts() const {
  std::vector<std::string> found;
  const auto examine = [&](const char* side, const Answer& answer,
                           const std::vector<cases::Doubt>& accepted) {
    const cases::Solution& solution = answer.solution;
    if (!answer.converged()) return;
    const auto doubt = [&](cases::Doubt kind, const std::string& what) {
      if (std::find(accepted.begin(), accepted.end(), kind) == accepted.end())
        found.push_back(fmt::format("{} {}, which the case does not accept ({}.accept = [\"{}\"])", side,
                                    what, side, cases::name_of(kind)));
    };
    if (solution.inverted_cells > 0)
      doubt(cases::Doubt::inverted, fmt::format("has {} inverted cells", solution.inverted_cells));
    if (solution.is_unstable()) doubt(cases::Doubt::unstable, "is in an unstable equilibrium");
  };
  examine("fem", answers.fem, scene.definition.fem.accepted);
  examine("msm", answers.msm, scene.definition.msm.accepted);
  return found;
}

std::vector<std::string> Comparison::failures() const {
  std::vector<std::string> found;
  if (gates.empty()) found.emplace_back("it expects nothing: there is no [[expect]]");
  for (const auto& [side, answer] : {std::pair("fem", &answers.fem), std::pair("msm", &answers.msm)})
    if (answer->solution.status == cases::Status::failed)
      found.push_back(describe_failure(side, answer->solution));
  for (std::string& doubt : doubts()) found.push_back(std::move(doubt));
  return found;
}

bool Comparison::is_sound() const {
  return !answers.failed() && doubts().empty() &&
         std::all_of(gates.begin(), gates.end(),
                     [](const Gate& gate) { return gate.met() || gate.is_left_out; });
}

bool Comparison::met() const {
  return failures().empty() &&
         std::all_of(gates.begin(), gates.end(), [](const Gate& gate) { return gate.met(); });
}

bool all_met(const std::vector<Comparison>& cases) {
  return std::all_of(cases.begin(), cases.end(), [](const Comparison& c) { return c.met(); });
}

} // namespace springproof::compare
