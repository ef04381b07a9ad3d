#include "compare/sweep/sweep.hpp"

#include "compare/provenance/stopwatch.hpp"
#include "compare/solve/process_pool.hpp"
#include "compare/solve/solve.hpp"

#include <mpi.h>

namespace springproof::compare {

namespace {

VariantRun failed_run(const std::string& reason) {
  VariantRun run;
  run.first.status = cases::Status::failed;
  run.first.message = reason;
  return run;
}

VariantRun run_in_own_process(const Sweep& sweep, const Variant& variant, const std::string& program) {
  const JobAnswer answer =
      run_in_processes(
          {{program, "worker", "--timing"}, 1}, 1,
          [&](std::size_t) { return timing_job(sweep.definition, variant, sweep.rules); },
          [](std::size_t, const JobAnswer&) {})
          .front();
  return answer.bytes ? variant_run_from(*answer.bytes) : failed_run(answer.reason);
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

} // namespace

Sweep run_sweep(const cases::Case& definition, Extent extent, const TimingRules& rules,
                const std::string& program, const std::function<void(const Sweep&)>& on_row) {
  Sweep sweep;
  const Stopwatch stopwatch;
  sweep.definition = definition;
  sweep.plan = plan_sweep(definition, extent);
  sweep.rules = rules;
  MPI_Comm_size(MPI_COMM_WORLD, &sweep.n_ranks);
  if (extent == Extent::quick || sweep.n_ranks > 1 || is_under_mpi_launcher())
    sweep.processes = Processes::this_one;
  if (const auto reason =
          reason_without_continuum_limit(scene_on(definition, field_cells(sweep.plan.reference[1]))))
    throw cases::InputError(definition.file + ": no reference to measure errors against: " + *reason);

  for (std::size_t v = 0; v < sweep.plan.variants.size(); ++v) {
    const Variant& variant = sweep.plan.variants[v];
    sweep.rows.push_back({variant,
                          sweep.processes == Processes::this_one
                              ? run_here(sweep, variant)
                              : run_in_own_process(sweep, variant, program),
                          std::nullopt,
                          {}});
    const std::size_t n_reference = sweep.plan.reference.size();
    if (v + 1 == n_reference) {
      find_reference(sweep);
      for (SweepRow& row : sweep.rows) finish(sweep, row);
    } else if (v >= n_reference) {
      finish(sweep, sweep.rows.back());
    }
    sweep.seconds = stopwatch.seconds();
    on_row(sweep);
  }
  return sweep;
}

} // namespace springproof::compare
