#include "cases/case/names.hpp"
#include "compare/measure/box_plot.hpp"
#include "compare/sweep/write_sweep.hpp"
#include "compare/write/csv.hpp"

namespace springproof::compare {

namespace {

using Columns = std::vector<std::optional<double>>;

/// Lower quartile, median, upper quartile.
Columns quartile_columns(const std::vector<double>& seconds) {
  if (seconds.empty()) return Columns(3);
  const BoxPlot box = box_plot(seconds);
  return {box.lower_quartile, box.median, box.upper_quartile};
}

Columns counter_columns(const cases::Solution& s) {
  return {s.newton_iterations, s.linear_iterations, s.factorisations, s.force_evaluations};
}

} // namespace

void write_sweep_csv(std::ostream& out, const Sweep& sweep) {
  CsvWriter csv(out, 10);
  std::vector<std::string> names{"case",   "method",  "cells_x",  "cells_y", "cells_z", "tolerance",
                                 "status", "message", "unknowns", "rounds",  "warm_up"};
  for (const std::string what : {"setup", "first", "again"})
    for (const char* quartile : {"_lower_quartile_s", "_median_s", "_upper_quartile_s"})
      names.push_back(what + quartile);
  for (const std::string what : {"first", "again"})
    for (const char* counter : {"_newton", "_cg", "_factorisations", "_forces"})
      names.push_back(what + counter);
  names.insert(names.end(), {"start_MB", "peak_MB", "field_error_percent"});
  for (const cases::Measure& measure : sweep.definition.measures)
    names.push_back(measure.name + "_error_percent");
  csv.row(names);
  for (const SweepRow& row : sweep.rows) {
    const VariantRun& run = row.run;
    Columns errors{row.field_error_percent};
    errors.insert(errors.end(), row.measure_error_percent.begin(), row.measure_error_percent.end());
    errors.resize(sweep.definition.measures.size() + 1);
    csv.row(sweep.definition.name, method_name(row.variant), row.variant.cells[0], row.variant.cells[1],
            row.variant.cells[2], row.variant.tolerance, cases::name_of(run.first.status), run.first.message,
            run.first.unknowns, run.first_seconds.size(), run.is_warm, quartile_columns(run.setup_seconds),
            quartile_columns(run.first_seconds), quartile_columns(run.again_seconds),
            counter_columns(run.first), run.again_seconds.empty() ? Columns(4) : counter_columns(run.again),
            run.start_megabytes, run.peak_megabytes, errors);
  }
}

} // namespace springproof::compare
