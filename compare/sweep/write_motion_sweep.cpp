#include "compare/sweep/write_motion_sweep.hpp"

#include "cases/case/names.hpp"
#include "compare/provenance/print.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/write/csv.hpp"
#include "compare/write/gnuplot.hpp"
#include "compare/write/json.hpp"
#include "compare/write/write.hpp"

#include <cmath>

namespace springproof::compare {

namespace {

constexpr std::array<double, 3> marks_of_steps{5, 7, 9}; ///< square, disc, triangle, of gnuplot

} // namespace

void write_motion_sweep_text(std::ostream& out, const MotionSweep& sweep) {
  print(out, "{}: {}\n", sweep.definition.name, sweep.definition.description);
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
  for (const double hertz : {30., 60., 500.}) print(out, "{}\n", interactive_sentence(sweep, hertz));
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
  using Json = nlohmann::ordered_json;
  Json document = provenance();
  document["case"] = sweep.definition.name;
  document["description"] = sweep.definition.description;
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
  document["conclusions"] = Json::array();
  for (const double hertz : {30., 60., 500.})
    document["conclusions"].push_back(interactive_sentence(sweep, hertz));
  return document;
}

void plot_motion_sweep(const std::string& folder, const MotionSweep& sweep) {
  std::vector<std::string> lines; // a block for each method and step
  std::vector<double> linetypes;  // as in all figures; a step's mark is the same for both models
  std::vector<double> markers;
  write_file(folder + "/motion_sweep_points.csv", [&](std::ostream& out) {
    CsvWriter csv(out, 8);
    for (const Family family : {Family::springs, Family::finite_elements})
      for (std::size_t s = 0; s < step_factors.size(); ++s) {
        const double step = step_factors[s] * sweep.definition.dynamics->step;
        std::string name;
        for (const MotionRow& row : sweep.rows) {
          if (row.family != family || std::abs(row.step - step) > 1e-9 * step || !row.error_percent) continue;
          name = fmt::format("{}, {:g} ms", row.method, 1e3 * step);
          csv.row(row.seconds_per_second, *row.error_percent);
        }
        if (name.empty()) continue;
        csv.end_block();
        lines.push_back(name);
        linetypes.push_back(family == Family::finite_elements ? 1 : 2);
        markers.push_back(marks_of_steps[s]);
      }
  });
  if (lines.empty()) return;
  draw(folder, "motion_sweep", "motion_sweep",
       {{"points", "motion_sweep_points.csv"},
        {"headline", sweep.definition.name + ": motions, one thread"},
        {"lines", lines},
        {"linetypes", linetypes},
        {"markers", markers},
        {"uncertainty", sweep.uncertainty_percent},
        {"width", 1000.},
        {"height", 600.}});
}

} // namespace springproof::compare
