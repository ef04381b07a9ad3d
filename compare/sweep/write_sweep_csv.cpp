#include "cases/case/names.hpp"
#include "compare/measure/box_plot.hpp"
#include "compare/sweep/write_sweep.hpp"
#include "compare/write/csv.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

namespace springproof::compare {

namespace {

/// Lower quartile, median, upper quartile.
std::string quartile_columns(const std::vector<double>& seconds) {
  if (seconds.empty()) return ",,";
  const BoxPlot box = box_plot(seconds);
  return fmt::format("{:.6g},{:.6g},{:.6g}", box.lower_quartile, box.median, box.upper_quartile);
}

/// Of the first solve and of the re-solve.
std::string counters(const VariantRun& run, bool has_again) {
  const auto four = [](const cases::Solution& s) {
    return fmt::format("{},{},{},{}", s.newton_iterations, s.linear_iterations, s.factorisations,
                       s.force_evaluations);
  };
  return four(run.first) + "," + (has_again ? four(run.again) : ",,,");
}

} // namespace

void write_sweep_csv(std::ostream& out, const Sweep& sweep) {
  fmt::print(out, "case,method,cells_x,cells_y,cells_z,tolerance,status,message,unknowns,rounds,warm_up");
  for (const char* what : {"setup", "first", "again"})
    fmt::print(out, ",{0}_lower_quartile_s,{0}_median_s,{0}_upper_quartile_s", what);
  for (const char* what : {"first", "again"})
    fmt::print(out, ",{0}_newton,{0}_cg,{0}_factorisations,{0}_forces", what);
  fmt::print(out, ",start_MB,peak_MB,field_error_percent");
  for (const cases::Measure& measure : sweep.definition.measures)
    fmt::print(out, ",{}", csv_text(measure.name + "_error_percent"));
  fmt::print(out, "\n");
  for (const SweepRow& row : sweep.rows) {
    const VariantRun& run = row.run;
    fmt::print(out, "{},{},{},{},{},{:g},{},{},{},{},{},", csv_text(sweep.definition.name),
               method_name(row.variant), row.variant.cells[0], row.variant.cells[1], row.variant.cells[2],
               row.variant.tolerance, cases::name_of(run.first.status), csv_text(run.first.message),
               run.first.unknowns, run.first_seconds.size(), run.is_warm ? 1 : 0);
    fmt::print(out, "{},{},{},{},{},{},{}", quartile_columns(run.setup_seconds),
               quartile_columns(run.first_seconds), quartile_columns(run.again_seconds),
               counters(run, !run.again_seconds.empty()), csv_number(run.start_megabytes),
               csv_number(run.peak_megabytes), csv_number(row.field_error_percent));
    for (std::size_t m = 0; m < sweep.definition.measures.size(); ++m)
      fmt::print(out, ",{}",
                 m < row.measure_error_percent.size() ? csv_number(row.measure_error_percent[m]) : "");
    fmt::print(out, "\n");
  }
}

} // namespace springproof::compare
