#include "compare/solve/comparison.hpp"

#include "compare/measure/measure.hpp"
#include "compare/provenance/mpi_rank.hpp"
#include "compare/solve/auto_fem.hpp"
#include "compare/solve/design.hpp"
#include "compare/solve/solve_side.hpp"
#include "msm/model.hpp"
#include "msm/snes/snes.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

std::optional<double> value_on(const cases::Measure& measure, const cases::Scene& scene, const Side& side) {
  if (side.solution.status != cases::Status::converged) return std::nullopt;
  return evaluate(measure, scene, side.solution);
}

std::vector<MeasuredValue> measure_all(const Comparison& comparison) {
  std::vector<MeasuredValue> values;
  for (const cases::Measure& measure : comparison.scene.definition.measures) {
    MeasuredValue value{measure.name, unit_of(measure), value_on(measure, comparison.scene, comparison.fem),
                        value_on(measure, comparison.scene, comparison.msm), std::nullopt};
    if (comparison.peer) value.peer = value_on(measure, comparison.scene, comparison.peer->side);
    if (value.fem && value.msm)
      value.error_percent =
          measure_error_percent(measure, comparison.scene, comparison.fem.solution, comparison.msm.solution);
    values.push_back(value);
  }
  return values;
}

/// PETSc's solver takes all ranks, the others rank 0 alone.
Side solve_springs(Comparison& comparison) {
  const auto designed = [&] {
    comparison.design = design_for(comparison.scene);
    return stiffness_of_cells(*comparison.design);
  };
  if (comparison.scene.definition.msm.solver == cases::Solver::snes)
    return solve_side(designed, [&](const std::vector<msm::CellStiffness>& stiffness) {
      return msm::solve_by_snes(comparison.scene, stiffness, MPI_COMM_WORLD);
    });
  if (mpi_rank() != 0) return {};
  return solve_side([&] { return msm::Model(comparison.scene, designed()); },
                    [](msm::Model& model) { return model.solve(); });
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
  if (!std::isfinite(*value))
    return {expectation, Verdict::missed, std::nullopt, "it is not a finite number"};
  if (expectation.interval[0] <= *value && *value <= expectation.interval[1])
    return {expectation, Verdict::met, value, ""};
  return {expectation, Verdict::missed, value,
          fmt::format("{:.6g} is outside [{:.6g}, {:.6g}]", *value, expectation.interval[0],
                      expectation.interval[1])};
}

Comparison compare_case(const cases::Case& definition, Only only) {
  Comparison comparison;
  comparison.scene = cases::make_scene(definition);
  if (only != Only::msm) comparison.fem = solve_fem(comparison.scene, comparison.choices);
  if (only != Only::fem) comparison.msm = solve_springs(comparison);
  measure_sides(comparison);
  return comparison;
}

void measure_sides(Comparison& comparison) {
  comparison.measures = measure_all(comparison);
  comparison.judgements.clear();
  for (const cases::Expectation& expectation : comparison.scene.definition.expectations)
    comparison.judgements.push_back(judge(expectation, comparison.measures));
}

} // namespace springproof::compare
