#include "compare/comparison.hpp"

#include "compare/design.hpp"
#include "compare/measure.hpp"
#include "compare/stopwatch.hpp"
#include "fem_reference/model.hpp"
#include "msm/model.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace compare {

namespace {

/// Builds a model and solves it; both sides have the same two steps.
template<class MakeModel>
Side solve_side(const MakeModel& make_model) {
  Side side;
  Stopwatch stopwatch;
  try {
    auto model = make_model();
    side.setup_seconds = stopwatch.lap();
    side.solution = model.solve();
  } catch (const cases::SolveError& error) {
    side.solution = {};
    side.solution.status = cases::Status::failed;
    side.solution.message = error.what();
    side.solution.outcome = error.outcome();
    side.solution.load_reached = error.load_reached();
    side.solution.residual = error.residual();
  }
  side.solve_seconds = stopwatch.lap();
  return side;
}

std::optional<double> value_on(const cases::Measure& measure, const cases::Scene& scene, const Side& side) {
  if (side.solution.status != cases::Status::converged) return std::nullopt;
  return evaluate(measure, scene, side.solution);
}

std::vector<MeasuredValue> measure_all(const Comparison& comparison) {
  std::vector<MeasuredValue> values;
  for (const cases::Measure& measure : comparison.scene.definition.measures) {
    MeasuredValue value{measure.name, unit_of(measure), value_on(measure, comparison.scene, comparison.fem),
                        value_on(measure, comparison.scene, comparison.msm), std::nullopt};
    if (value.fem && value.msm)
      value.error_percent =
          measure_error_percent(measure, comparison.scene, comparison.fem.solution, comparison.msm.solution);
    values.push_back(value);
  }
  return values;
}

int rank() {
  int number = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &number);
  return number;
}

} // namespace

bool Comparison::failed() const {
  const bool peer_failed = peer && peer->side.solution.status == cases::Status::failed;
  return fem.solution.status == cases::Status::failed || msm.solution.status == cases::Status::failed ||
         peer_failed;
}

Judgement judge(const cases::Expectation& expectation, const std::vector<MeasuredValue>& measures) {
  const auto found = std::find_if(measures.begin(), measures.end(),
                                  [&](const MeasuredValue& m) { return m.name == expectation.measure; });
  if (found == measures.end())
    return {expectation, Verdict::missed, std::nullopt, "there is no such measure"};
  std::optional<double> value;
  switch (expectation.quantity) {
  case cases::Quantity::error_percent:
    value = found->error_percent;
    break;
  case cases::Quantity::msm:
    value = found->msm;
    break;
  case cases::Quantity::fem:
    value = found->fem;
    break;
  }
  if (!value)
    return {expectation, Verdict::missed, value, "it has no value: a side failed or was not solved"};
  if (expectation.interval[0] <= *value && *value <= expectation.interval[1])
    return {expectation, Verdict::met, value, ""};
  return {expectation, Verdict::missed, value,
          fmt::format("{:.6g} is outside [{:.6g}, {:.6g}]", *value, expectation.interval[0],
                      expectation.interval[1])};
}

Comparison compare_case(const cases::Case& definition, Only only) {
  Comparison comparison;
  comparison.scene = cases::make_scene(definition);
  if (only != Only::msm)
    comparison.fem = solve_side([&] { return fem_reference::Model(comparison.scene, MPI_COMM_WORLD); });
  if (only != Only::fem && rank() == 0)
    comparison.msm = solve_side([&] {
      comparison.design = design_for(comparison.scene);
      return msm::Model(comparison.scene, stiffness_of_cells(*comparison.design));
    });
  measure_sides(comparison);
  return comparison;
}

void measure_sides(Comparison& comparison) {
  comparison.measures = measure_all(comparison);
  comparison.judgements.clear();
  for (const cases::Expectation& expectation : comparison.scene.definition.expectations)
    comparison.judgements.push_back(judge(expectation, comparison.measures));
}

} // namespace compare
