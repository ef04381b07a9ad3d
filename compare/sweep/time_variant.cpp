#include "compare/sweep/time_variant.hpp"

#include "compare/peers/calculix.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/solve/fields.hpp"
#include "compare/solve/solve.hpp"
#include "compare/solve/springs.hpp"
#include "fem_reference/model.hpp"
#include "msm/model.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>

namespace cereal {

SPRINGPROOF_FIELDS(springproof::compare::Variant, program, design, formulation, element, cells, tolerance)
SPRINGPROOF_FIELDS(springproof::compare::TimingRules, repetitions, budget_seconds)
SPRINGPROOF_FIELDS(springproof::compare::VariantRun, first, again, setup_seconds, first_seconds,
                   again_seconds, is_warm, peak_megabytes, start_megabytes)

} // namespace cereal

namespace springproof::compare {

namespace {

/// One model made and solved twice: from rest, and after the change of the load.
struct Round {
  std::optional<double> setup_seconds; ///< absent where they are part of the first solve's
  Answer first, again;
};

/// One solve of a model that is there.
Answer timed(const std::function<cases::Solution()>& solve) {
  return solve_side([] { return 0; }, [&](int) { return solve(); });
}

bool is_solved(const Answer& answer) {
  return answer.solution.status == cases::Status::converged;
}

cases::Scene with_load(cases::Scene scene, double factor) {
  for (auto& applied : scene.loads) {
    applied.load.value *= factor;
    applied.load.moment *= factor;
  }
  for (auto& moved : scene.moved) {
    moved.motion.displacement *= factor;
    moved.motion.angle *= factor;
  }
  return scene;
}

msm::Model make_springs(const cases::Scene& scene) {
  return msm::Model(scene, stiffness_of_cells(design_for(scene)));
}

/// @param before  displacement under the smaller load
Round solve_springs(const cases::Scene& scene, double tolerance, const msm::Points& before) {
  Round round;
  Stopwatch stopwatch;
  msm::Model model = make_springs(scene);
  round.setup_seconds = stopwatch.lap();
  mechanics::EquilibriumSettings settings;
  settings.tolerance = tolerance;
  settings.stability = mechanics::Stability::ignore;
  round.first = timed([&] { return model.solve(settings); });
  if (is_solved(round.first)) round.again = timed([&] { return model.solve(settings, before); });
  return round;
}

/// Under the smaller load, where the equilibrium has to be stable.
Answer springs_before(const cases::Scene& scene, double tolerance) {
  mechanics::EquilibriumSettings settings;
  settings.tolerance = tolerance;
  return solve_side([&] { return make_springs(with_load(scene, 1 - load_change)); },
                    [&](msm::Model& model) { return model.solve(settings); });
}

/// All ranks go by what rank 0 measured.
double agreed(double seconds) {
  MPI_Bcast(&seconds, 1, MPI_DOUBLE, 0, MPI_COMM_WORLD);
  return seconds;
}

/// Displacements of nodes that are those of a grid, in its order.
msm::Points on_grid(const std::vector<fem_reference::NodeDisplacement>& nodes, const Eigen::Vector3d& size,
                    const std::array<int, 3>& cells) {
  msm::Points field(static_cast<std::size_t>(cells[0] + 1) * static_cast<std::size_t>(cells[1] + 1) *
                    static_cast<std::size_t>(cells[2] + 1));
  for (const auto& node : nodes) {
    long place = 0;
    for (int axis = 2; axis >= 0; --axis) {
      const int n = cells[static_cast<std::size_t>(axis)];
      place = place * (n + 1) + std::lround(node.rest[axis] / size[axis] * n);
    }
    field[static_cast<std::size_t>(place)] = node.displacement;
  }
  return field;
}

Round solve_finite_elements(const cases::Scene& scene, const Variant& variant, const TimingRules& rules) {
  Round round;
  Stopwatch stopwatch;
  fem_reference::Model model(scene, MPI_COMM_WORLD);
  round.setup_seconds = stopwatch.lap();
  mechanics::EquilibriumSettings settings = fem_reference::default_settings();
  settings.tolerance = variant.tolerance;
  settings.stability = mechanics::Stability::ignore;
  round.first = timed([&] { return model.solve(settings); });
  if (!is_solved(round.first)) return round;
  if (field_cells(variant) != variant.cells)
    round.first.solution.displacement = on_grid(
        model.node_displacements(), std::get<cases::Box>(scene.definition.body).size, field_cells(variant));
  if (agreed(round.first.solve_seconds) > rules.budget_seconds) {
    round.again.solution.message = "left out: the first solve took longer than the budget";
    return round;
  }
  round.again = timed([&] { return model.solve_again(1 - load_change, settings); });
  if (is_solved(round.again)) round.again = timed([&] { return model.solve_again(1, settings); });
  return round;
}

/// A program of its own: reading its input and writing its output are part of the only time there is.
Round ask_calculix_once(const cases::Scene& scene) {
  return {std::nullopt, timed([&] { return solve_with_calculix(scene); }), {}};
}

void append(VariantRun& run, Round round) {
  if (round.setup_seconds) run.setup_seconds.push_back(*round.setup_seconds);
  if (is_solved(round.first)) run.first_seconds.push_back(round.first.solve_seconds);
  if (is_solved(round.again)) run.again_seconds.push_back(round.again.solve_seconds);
  run.first = std::move(round.first.solution);
  run.again = std::move(round.again.solution);
  run.again.displacement.clear();
  run.again.cell_volume.clear();
}

VariantRun repeat(const std::function<Round()>& solve, const TimingRules& rules,
                  const std::function<double(double)>& agree) {
  VariantRun run;
  const Stopwatch stopwatch;
  Round trial = solve();
  const double seconds = agree(stopwatch.seconds());
  const int n = is_solved(trial.first) ? n_repetitions(seconds, rules) : 0;
  run.is_warm = n > 0;
  if (n == 0) append(run, std::move(trial));
  for (int i = 0; i < n; ++i) append(run, solve());
  return run;
}

VariantRun time_springs(const cases::Scene& scene, double tolerance, const TimingRules& rules) {
  const Answer before = springs_before(scene, tolerance);
  if (is_solved(before))
    return repeat([&] { return solve_springs(scene, tolerance, before.solution.displacement); }, rules,
                  [](double seconds) { return seconds; });
  VariantRun run;
  run.first = before.solution;
  return run;
}

} // namespace

int n_repetitions(double seconds_of_first, const TimingRules& rules) {
  if (!(seconds_of_first <= rules.budget_seconds)) return 0;
  if (!(seconds_of_first * rules.repetitions > rules.budget_seconds)) return rules.repetitions;
  return std::max(1, static_cast<int>(rules.budget_seconds / seconds_of_first));
}

VariantRun time_variant(const cases::Case& definition, const Variant& variant, const TimingRules& rules) {
  const cases::Scene scene = cases::make_scene(with_variant(definition, variant));
  switch (variant.program) {
  case Program::springs:
    if (mpi_rank() != 0) return {};
    return time_springs(scene, variant.tolerance, rules);
  case Program::finite_elements:
    return repeat([&] { return solve_finite_elements(scene, variant, rules); }, rules, agreed);
  case Program::calculix:
    if (mpi_rank() != 0) return {};
    return repeat([&] { return ask_calculix_once(scene); }, rules, [](double seconds) { return seconds; });
  }
  return {}; // not reached: every program is above
}

std::string timing_job(const cases::Case& definition, const Variant& variant, const TimingRules& rules) {
  return cases::to_bytes(definition, variant, rules);
}

std::string answer_timing_job(const std::string& job) {
  cases::Case definition;
  Variant variant;
  TimingRules rules;
  cases::from_bytes(job, definition, variant, rules);
  const std::optional<double> before = peak_resident_megabytes();
  VariantRun run = time_variant(definition, variant, rules);
  if (variant.program != Program::calculix) { // whose memory is another process's
    run.start_megabytes = before;
    run.peak_megabytes = peak_resident_megabytes();
  }
  return cases::to_bytes(run);
}

VariantRun variant_run_from(const std::string& answer) {
  VariantRun run;
  cases::from_bytes(answer, run);
  return run;
}

} // namespace springproof::compare
