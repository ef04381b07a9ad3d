#include "compare/sweep/sweep.hpp"

#include "compare/measure/box_plot.hpp"
#include "compare/provenance/stopwatch.hpp"
#include "compare/solve/process_pool.hpp"
#include "compare/solve/solve.hpp"

#include <algorithm>
#include <cmath>
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

std::optional<double> worst_measure_error(const SweepRow& row) {
  std::optional<double> worst;
  for (const auto& error : row.measure_error_percent)
    if (error) worst = std::max(worst.value_or(0), std::abs(*error));
  return worst;
}

std::optional<double> error_of(const SweepRow& row, Error error) {
  return error == Error::field ? row.field_error_percent : worst_measure_error(row);
}

std::optional<double> median_seconds(const SweepRow& row, Clock clock) {
  if (clock == Clock::re_solve) return median(row.run.again_seconds);
  const auto first = median(row.run.first_seconds);
  if (!first) return std::nullopt;
  return *first + median(row.run.setup_seconds).value_or(0); // CalculiX does not tell them apart
}

std::vector<Point> points_of(const Sweep& sweep, Error error, Clock clock) {
  std::vector<Point> points;
  for (const SweepRow& row : sweep.rows) {
    const auto seconds = median_seconds(row, clock), percent = error_of(row, error);
    if (seconds && percent)
      points.push_back({full_name(row.variant), family_of(row.variant), *seconds, *percent});
  }
  return points;
}

std::vector<std::optional<double>> errors_by_level(const Sweep& sweep, const std::string& method,
                                                   Error error) {
  std::vector<std::optional<double>> errors;
  for (const auto& cells : sweep.plan.levels) {
    const SweepRow* tightest = nullptr;
    for (const SweepRow& row : sweep.rows)
      if (method_name(row.variant) == method && row.variant.cells == cells &&
          (!tightest || row.variant.tolerance < tightest->variant.tolerance))
        tightest = &row;
    errors.push_back(tightest ? error_of(*tightest, error) : std::nullopt);
  }
  return errors;
}

double uncertainty_percent(const Reference& reference, Error error) {
  if (error == Error::field) return reference.field.uncertainty_percent;
  double largest = 0;
  for (const ReferenceValue& value : reference.measures)
    largest = std::max(largest, value.uncertainty_percent);
  return largest;
}

std::vector<std::string> methods_of(const Sweep& sweep) {
  std::vector<std::string> methods;
  for (const SweepRow& row : sweep.rows) {
    const std::string method = method_name(row.variant);
    if (std::find(methods.begin(), methods.end(), method) == methods.end()) methods.push_back(method);
  }
  return methods;
}

} // namespace springproof::compare
