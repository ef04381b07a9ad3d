#include "compare/sweep/write_motion_sweep.hpp"

#include "cases/case/names.hpp"
#include "compare/provenance/print.hpp"
#include "compare/sweep/error_plot.hpp"
#include "compare/sweep/motion_conclusions.hpp"
#include "compare/sweep/write_sweep.hpp"
#include "compare/table/table.hpp"
#include "compare/write/write.hpp"

#include <cmath>

namespace springproof::compare {

namespace {

/// Motions with the case's own step are joined, which all methods have.
std::vector<Series> series_of(const MotionSweep& sweep) {
  std::vector<Series> all;
  std::array<int, 2> n_designs{}; // ours, and of others
  for (const MotionRow& row : sweep.rows) {
    if (all.empty() || all.back().method != row.method) {
      Appearance appearance{1};
      if (row.design)
        appearance =
            appearance_of_springs(*row.design, n_designs.at(cases::is_of_others(*row.design) ? 1 : 0)++);
      all.push_back({row.method, appearance});
    }
    const double step = sweep.definition.dynamics->step;
    if (const auto point = point_of(sweep, row))
      all.back().add(*point, std::abs(row.step - step) < 1e-9 * step);
  }
  return all;
}

} // namespace

void write_motion_sweep_text(std::ostream& out, const MotionSweep& sweep) {
  print(out, "{}: {}\n", sweep.definition.name, sweep.definition.description);
  for (const std::string& setting : sweep.settings) print(out, "  with {}\n", setting);
  print(out, "  one run of each on one thread, one after the other; times without setting up\n");
  print(out, "  reference: {}; uncertainty {:.2g} %\n", sweep.reference, sweep.uncertainty_percent);
  print(out, "  {:<34}{:>12} {:>9} {:>9} {:>24} {:>9}\n", "method", "cells", "step, ms", "unknowns",
        "s of computing a second", "error, %");
  for (const MotionRow& row : sweep.rows) {
    print(out, "  {:<34}{:>12} {:>9.4g} {:>9}", row.method, cells_name(row.cells), 1e3 * row.step,
          row.unknowns);
    if (row.error_percent)
      print(out, " {:>24.3g} {:>9.3g}\n", row.seconds_per_second, *row.error_percent);
    else
      print(out, " {}: {}\n", cases::name_of(row.status), row.message);
  }
  for (const LeftOut& left : sweep.left_out) print(out, "left out: {}: {}\n", left.what, left.reason);
  for (const std::string& sentence : conclusions(sweep)) print(out, "{}\n", sentence);
}

void write_motion_sweep_csv(std::ostream& out, const MotionSweep& sweep) {
  CsvWriter csv(out, 10);
  csv.row("case", "method", "cells_x", "cells_y", "cells_z", "step_s", "status", "message", "unknowns",
          "seconds_per_second", "error_percent");
  for (const MotionRow& row : sweep.rows) {
    const auto seconds = row.error_percent ? std::optional(row.seconds_per_second) : std::nullopt;
    csv.row(sweep.definition.name, row.method, row.cells[0], row.cells[1], row.cells[2], row.step,
            cases::name_of(row.status), row.message, row.unknowns, seconds, row.error_percent);
  }
}

nlohmann::ordered_json motion_sweep_to_json(const MotionSweep& sweep) {
  Json document = provenance();
  document["case"] = sweep.definition.name;
  document["description"] = sweep.definition.description;
  document["settings"] = sweep.settings;
  document["threads"] = 1;
  document["reference"] = {{"motion", sweep.reference}, {"uncertainty_percent", sweep.uncertainty_percent}};
  document["motions"] = Json::array();
  for (const MotionRow& row : sweep.rows) {
    Json entry{{"method", row.method},          {"cells", row.cells},
               {"step_seconds", row.step},      {"status", cases::name_of(row.status)},
               {"message", row.message},        {"unknowns", row.unknowns},
               {"seconds_per_second", nullptr}, {"error_percent", nullptr}};
    if (row.error_percent) {
      entry["seconds_per_second"] = row.seconds_per_second;
      entry["error_percent"] = *row.error_percent;
    }
    document["motions"].push_back(entry);
  }
  document["left_out"] = left_out_to_json(sweep.left_out);
  document["conclusions"] = conclusions(sweep);
  return document;
}

void plot_motion_sweep(const std::string& folder, const MotionSweep& sweep) {
  const double ms = 1e3 * sweep.definition.dynamics->step;
  ErrorPlot plot{
      "motion_sweep", "motion_sweep_points.csv",
      fmt::format("{}: motions on one thread; lines: steps of {:g} ms, small marks: {:g} and {:g} ms",
                  sweep.definition.name, ms, step_factors[0] * ms, step_factors[2] * ms),
      "computing for a second of motion", "s"};
  plot.real_time = 1;
  plot.uncertainty = sweep.uncertainty_percent;
  plot.series = series_of(sweep);
  plot.points = points_of(sweep);
  plot_errors(folder, plot);
}

} // namespace springproof::compare
