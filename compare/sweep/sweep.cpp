#include "compare/sweep/sweep.hpp"

#include "compare/peers/calculix.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/solve/fields.hpp"
#include "compare/solve/process_pool.hpp"
#include "compare/solve/progress.hpp"
#include "compare/solve/ranks.hpp"
#include "compare/solve/solve.hpp"
#include "compare/solve/solvers.hpp"
#include "compare/solve/springs.hpp"
#include "msm/model.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace cereal {

SPRINGPROOF_FIELDS(springproof::compare::Variant, program, design, formulation, element, cells, tolerance,
                   step, real_time)
SPRINGPROOF_FIELDS(springproof::compare::TimingRules, repetitions, budget_seconds)
SPRINGPROOF_FIELDS(springproof::compare::VariantRun, first, again, setup_seconds, first_seconds,
                   again_seconds, is_warm, peak_megabytes, start_megabytes)

} // namespace cereal

namespace springproof::compare {

namespace {

using Times = std::vector<double>; ///< seconds

/// One solve of a model that is there; its time counts if it found an equilibrium, and so says the answer.
bool solve_timed(cases::Solution& solution, Times& times, const std::function<cases::Solution()>& solve) {
  Answer answer = solve_side([] { return 0; }, [&](int) { return solve(); });
  if (answer.converged()) times.push_back(answer.solve_seconds);
  solution = std::move(answer.solution);
  return solution.status == cases::Status::converged;
}

cases::Scene with_load(cases::Scene scene, double factor) {
  for (auto& applied : scene.loads) applied.load.scale(factor);
  for (auto& moved : scene.moved) {
    moved.motion.displacement *= factor;
    moved.motion.angle *= factor;
  }
  return scene;
}

msm::Model make_springs(const cases::Scene& scene) {
  return msm::Model(scene, design_for(scene).springs);
}

/// A round: the model made and solved twice, from rest and after the change of the load.
/// @param before  displacement under the smaller load
void solve_springs(VariantRun& run, const cases::Scene& scene, double tolerance, const msm::Points& before) {
  Stopwatch stopwatch;
  msm::Model model = make_springs(scene);
  run.setup_seconds.push_back(stopwatch.lap());
  mechanics::EquilibriumSettings settings;
  settings.tolerance = tolerance;
  settings.stability = mechanics::Stability::ignore;
  if (solve_timed(run.first, run.first_seconds, [&] { return model.solve(settings); }))
    solve_timed(run.again, run.again_seconds, [&] { return model.solve(settings, before); });
}

/// Solves under the smaller load, where the equilibrium has to be stable.
Answer springs_before(const cases::Scene& scene, double tolerance) {
  mechanics::EquilibriumSettings settings;
  settings.tolerance = tolerance;
  return solve_side([&] { return make_springs(with_load(scene, 1 - load_change)); },
                    [&](msm::Model& model) { return model.solve(settings); });
}

/// All ranks go by what rank 0 measured.
double agreed(double seconds) {
  if (n_mpi_ranks() > 1) MPI_Bcast(&seconds, 1, MPI_DOUBLE, 0, MPI_COMM_WORLD);
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

/// A round, as of springs.
void solve_finite_elements(VariantRun& run, const cases::Scene& scene, const Variant& variant,
                           const TimingRules& rules) {
  solvers(); // loading them is no part of the time
  Stopwatch stopwatch;
  const auto model = make_finite_elements(scene);
  run.setup_seconds.push_back(stopwatch.lap());
  mechanics::EquilibriumSettings settings = fem_reference::default_settings();
  settings.tolerance = variant.tolerance;
  settings.stability = mechanics::Stability::ignore;
  if (!solve_timed(run.first, run.first_seconds, [&] { return model->solve(settings); })) return;
  run.first = gathered(std::move(run.first));
  if (field_cells(variant) != variant.cells)
    run.first.displacement = on_grid(model->node_displacements(),
                                     std::get<cases::Box>(scene.definition.body).size, field_cells(variant));
  if (agreed(run.first_seconds.back()) > rules.budget_seconds) {
    run.again.message = "left out: the first solve took longer than the budget";
    return;
  }
  Times untold;
  if (solve_timed(run.again, untold, [&] { return model->solve_again(1 - load_change, settings); }))
    solve_timed(run.again, run.again_seconds, [&] { return model->solve_again(1, settings); });
}

/// A first round stands for all when the budget does not pay for others, else it is the warm-up.
VariantRun repeat(const std::function<void(VariantRun&)>& add_round, const TimingRules& rules,
                  const std::function<double(double)>& agree) {
  VariantRun run;
  const auto add = [&] {
    run.again = {};
    add_round(run);
    run.again.displacement.clear();
    run.again.cell_volume.clear();
  };
  const Stopwatch stopwatch;
  add();
  const double seconds = agree(stopwatch.seconds());
  const int n = run.first.status == cases::Status::converged ? n_repetitions(seconds, rules) : 0;
  if (n == 0) return run;
  run = {};
  run.is_warm = true;
  for (int i = 0; i < n; ++i) add();
  return run;
}

VariantRun failed_run(const std::string& reason) {
  VariantRun run;
  run.first.status = cases::Status::failed;
  run.first.message = reason;
  return run;
}

VariantRun run_in_own_process(const Sweep& sweep, const Variant& variant, const std::string& program) {
  const JobAnswer answer =
      run_in_processes(
          {program, "worker", "--timing"}, 1, 1,
          [&](std::size_t) { return timing_job(sweep.definition, variant, sweep.rules); },
          [](std::size_t, const JobAnswer&) {})
          .front();
  return answer.bytes ? variant_run_from(*answer.bytes, variant) : failed_run(answer.reason);
}

VariantRun run_here(const Sweep& sweep, const Variant& variant) {
  try {
    return time_variant(sweep.definition, variant, sweep.rules);
  } catch (const std::exception& error) { // whatever it is, the other variants go on
    return failed_run(error.what());
  }
}

/// The reference's variants are the first of the plan.
void find_reference(Sweep& sweep) {
  std::array<std::array<int, 3>, 3> cells;
  std::array<std::vector<Eigen::Vector3d>, 3> displacement;
  for (std::size_t mesh = 0; mesh < 3; ++mesh) {
    const SweepRow& row = sweep.rows[mesh];
    if (row.run.first.status != cases::Status::converged) {
      sweep.reason_without_reference =
          "the reference's " + full_name(row.variant) + " was not solved: " + row.run.first.message;
      return;
    }
    cells[mesh] = field_cells(row.variant);
    displacement[mesh] = row.run.first.displacement;
  }
  sweep.reference = make_reference(sweep.definition, cells, displacement);
}

/// Holds a row against the reference, and drops its displacement.
void finish(const Sweep& sweep, SweepRow& row) {
  cases::Solution& solution = row.run.first;
  if (sweep.reference && solution.status == cases::Status::converged && !solution.displacement.empty()) {
    const auto cells = field_cells(row.variant);
    row.field_error_percent = field_error_percent(*sweep.reference, cells, solution.displacement);
    row.measure_error_percent = measure_errors_percent(*sweep.reference, cells, solution.displacement);
  }
  solution.displacement = {};
  solution.cell_volume = {};
}

/// Solves and times a variant, in a process of its own or in this one (then collective).
/// @param program  whose hidden command `worker` serves
VariantRun run_variant(const Sweep& sweep, const Variant& variant, const std::string& program,
                       ProgressLine& line) {
  line.begin(full_name(variant), estimate_of(sweep, variant).seconds);
  VariantRun run = sweep.processes == Processes::this_one ? run_here(sweep, variant)
                                                          : run_in_own_process(sweep, variant, program);
  line.finish(full_name(variant));
  return run;
}

/// Adds the next of the plan's variants. With the last mesh of the reference, all rows get their errors.
void add_row(Sweep& sweep, const Variant& variant, VariantRun run) {
  sweep.rows.push_back({variant, std::move(run)});
  const std::size_t n_reference = sweep.plan.reference.size();
  if (sweep.rows.size() == n_reference) {
    find_reference(sweep);
    for (SweepRow& row : sweep.rows) finish(sweep, row);
  } else if (sweep.rows.size() > n_reference) {
    finish(sweep, sweep.rows.back());
  }
}

} // namespace

int n_repetitions(double seconds_of_first, const TimingRules& rules) {
  if (!(seconds_of_first <= rules.budget_seconds)) return 0;
  if (!(seconds_of_first * rules.repetitions > rules.budget_seconds)) return rules.repetitions;
  return std::max(1, static_cast<int>(rules.budget_seconds / seconds_of_first));
}

VariantRun time_variant(const cases::Case& definition, const Variant& variant, const TimingRules& rules) {
  const cases::Scene scene = cases::make_scene(with_variant(definition, variant));
  if (variant.program == Program::finite_elements)
    return repeat([&](VariantRun& run) { solve_finite_elements(run, scene, variant, rules); }, rules, agreed);
  if (mpi_rank() != 0) return {};
  const auto alone = [](double seconds) { return seconds; };
  if (variant.program == Program::calculix) // reading its input and writing its output are part of its time
    return repeat(
        [&](VariantRun& run) {
          solve_timed(run.first, run.first_seconds, [&] { return solve_with_calculix(scene); });
        },
        rules, alone);
  const Answer before = springs_before(scene, variant.tolerance);
  if (before.converged())
    return repeat(
        [&](VariantRun& run) { solve_springs(run, scene, variant.tolerance, before.solution.displacement); },
        rules, alone);
  VariantRun unstable;
  unstable.first = before.solution;
  return unstable;
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
  return bytes_of(run);
}

std::string bytes_of(const VariantRun& run) {
  return cases::to_bytes(run);
}

VariantRun variant_run_from(const std::string& answer, const Variant& variant) {
  VariantRun run;
  cases::from_bytes(answer, run);
  std::size_t n_nodes = 1;
  for (const int n_cells : field_cells(variant)) n_nodes *= cases::index(n_cells + 1);
  const std::vector<Eigen::Vector3d>& field = run.first.displacement;
  const bool is_solved = run.first.status == cases::Status::converged;
  if ((field.size() != n_nodes && (is_solved || !field.empty())) ||
      !std::all_of(field.begin(), field.end(), [](const Eigen::Vector3d& u) { return u.allFinite(); }))
    throw std::runtime_error("has a displacement that is none on the variant's mesh");
  return run;
}

bool has_answer(const Sweep& sweep) {
  if (!sweep.reference) return false;
  const auto first = sweep.rows.begin() + static_cast<std::ptrdiff_t>(sweep.plan.reference.size());
  return first == sweep.rows.end() || std::any_of(first, sweep.rows.end(), [](const SweepRow& row) {
           return row.run.first.status == cases::Status::converged;
         });
}

Sweep make_sweep(const cases::Case& definition, Extent extent, const TimingRules& rules,
                 const std::optional<double>& budget_seconds) {
  Sweep sweep;
  sweep.definition = definition;
  sweep.plan = plan_sweep(definition, extent);
  sweep.rules = rules;
  sweep.n_ranks = n_mpi_ranks();
  if (extent == Extent::quick || sweep.n_ranks > 1 || is_under_mpi_launcher())
    sweep.processes = Processes::this_one;
  if (const auto reason =
          reason_without_continuum_limit(scene_on(definition, field_cells(sweep.plan.reference[1]))))
    throw cases::InputError(definition.file + ": no reference to measure errors against: " + *reason);
  if (budget_seconds) cut_to_budget(sweep, *budget_seconds);
  return sweep;
}

Sweep run_sweep(Sweep sweep, const std::string& program, const std::function<void(const Sweep&)>& on_row) {
  const Stopwatch stopwatch;
  ProgressLine line(1);
  for (const double seconds : estimated_seconds(sweep)) line.expect(seconds);
  for (std::size_t v = 0; v < sweep.plan.variants.size(); ++v) {
    const Variant& variant = sweep.plan.variants[v];
    add_row(sweep, variant, run_variant(sweep, variant, program, line));
    sweep.seconds = stopwatch.seconds();
    on_row(sweep);
  }
  return sweep;
}

} // namespace springproof::compare
