#include "compare/sweep/write_sweep.hpp"

#include "cases/case/names.hpp"
#include "compare/measure/box_plot.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/print.hpp"
#include "compare/sweep/analysis.hpp"
#include "compare/sweep/error_plot.hpp"
#include "compare/table/table.hpp"
#include "compare/write/write.hpp"

#include <algorithm>
#include <array>

namespace springproof::compare {

namespace {

/// Median and quartiles in milliseconds: "12.1 (11.9-12.4)".
std::string quartiles(const std::vector<double>& seconds) {
  if (seconds.empty()) return "-";
  const BoxPlot box = box_plot(seconds);
  if (seconds.size() == 1) return fmt::format("{:.3g}", 1e3 * box.median);
  return fmt::format("{:.3g} ({:.3g}-{:.3g})", 1e3 * box.median, 1e3 * box.lower_quartile,
                     1e3 * box.upper_quartile);
}

std::string percent(const std::optional<double>& value) {
  return value ? fmt::format("{:+.3g}", *value) : "-";
}

void write_head(std::ostream& out, const Sweep& sweep) {
  const Machine machine = describe_machine();
  print(out, "{}: {}\n", sweep.definition.name, sweep.definition.description);
  for (const std::string& setting : sweep.settings) print(out, "  with {}\n", setting);
  print(out, "  machine: {}, {} cores, {}, {}, {}\n", machine.processor, machine.cores, machine.system,
        machine.compiler, machine.blas);
  if (sweep.processes == Processes::one_per_variant)
    print(out, "  one variant at a time, each in a process of its own, on one thread\n");
  else
    print(out, "  one variant at a time, all in one process, so no memory; {} rank{}, one thread each{}\n",
          sweep.n_ranks, sweep.n_ranks == 1 ? "" : "s",
          sweep.n_ranks == 1 ? "" : " (springs on the first alone)");
  print(out,
        "  times: median (quartiles) of n rounds after a warm-up round; n = {} unless {:g} s do not pay "
        "for as many, 1* = no warm-up\n",
        sweep.rules.repetitions, sweep.rules.budget_seconds);
  print(out, "  re-solve: from 95 to 100 % of the load, from the displacement at 95 %\n");
}

void write_row(std::ostream& out, const SweepRow& row) {
  const VariantRun& run = row.run;
  const cases::Solution& s = run.first;
  print(out, "  {:<34}{:>10} {:>6}", method_name(row.variant), cells_name(row.variant.cells),
        row.variant.program == Program::calculix ? "-" : fmt::format("{:.0e}", row.variant.tolerance));
  if (s.status != cases::Status::converged) {
    print(out, "  {}: {}\n", cases::name_of(s.status), s.message);
    return;
  }
  const std::string n = fmt::format("{}{}", run.first_seconds.size(), run.is_warm ? "" : "*");
  print(out, " {:>8} {:>3} {:>22} {:>22} {:>22} {:>4} {:>5} {:>4} {:>5} {:>7}", s.unknowns, n,
        quartiles(run.setup_seconds), quartiles(run.first_seconds), quartiles(run.again_seconds),
        s.newton_iterations, s.linear_iterations, s.factorisations, s.force_evaluations,
        run.peak_megabytes ? fmt::format("{:.0f}", *run.peak_megabytes - run.start_megabytes.value_or(0))
                           : "-");
  print(out, " {:>8}", row.field_error_percent ? fmt::format("{:.3g}", *row.field_error_percent) : "-");
  for (const auto& error : row.measure_error_percent) print(out, " {:>9}", percent(error));
  print(out, "\n");
  if (run.again.status == cases::Status::failed)
    print(out, "  {:<34}re-solve failed: {}\n", "", run.again.message);
}

void write_reference(std::ostream& out, const Sweep& sweep) {
  if (!sweep.reference) {
    print(out, "no reference: {}\n", sweep.reason_without_reference);
    return;
  }
  const auto& meshes = sweep.plan.reference;
  print(out, "reference: {} on {}, {} and {}, extrapolated; displacements are compared on {}\n",
        method_name(meshes[0]), cells_name(meshes[0].cells), cells_name(meshes[1].cells),
        cells_name(meshes[2].cells), cells_name(sweep.reference->scene.mesh.grid->cells));
  const auto line = [&](const ReferenceValue& v) {
    print(out, "  {:<24} {:>12.6g} {:<4} +- {:.2g} %{}\n", v.name, v.value, v.unit, v.uncertainty_percent,
          v.note.empty() ? "" : "  (" + v.note + ")");
  };
  line(sweep.reference->field);
  for (const ReferenceValue& value : sweep.reference->measures) line(value);
}

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

Json times(const std::vector<double>& seconds) {
  if (seconds.empty()) return nullptr;
  const BoxPlot box = box_plot(seconds);
  return {{"median", box.median}, {"quartiles", {box.lower_quartile, box.upper_quartile}}, {"all", seconds}};
}

Json counters(const cases::Solution& s) {
  return {{"newton_iterations", s.newton_iterations},
          {"linear_iterations", s.linear_iterations},
          {"factorisations", s.factorisations},
          {"force_evaluations", s.force_evaluations},
          {"residual", s.residual}};
}

Json value_to_json(const ReferenceValue& v) {
  return {{"name", v.name},
          {"unit", v.unit},
          {"value", v.value},
          {"uncertainty_percent", v.uncertainty_percent},
          {"note", v.note}};
}

Json reference_to_json(const Sweep& sweep) {
  if (!sweep.reference) return {{"reason", sweep.reason_without_reference}};
  Json meshes = Json::array(), measures = Json::array();
  for (const Variant& mesh : sweep.plan.reference) meshes.push_back(mesh.cells);
  for (const ReferenceValue& value : sweep.reference->measures) measures.push_back(value_to_json(value));
  return {{"method", method_name(sweep.plan.reference.front())},
          {"meshes", meshes},
          {"compared_on", sweep.reference->scene.mesh.grid->cells},
          {"field", value_to_json(sweep.reference->field)},
          {"measures", measures}};
}

Json row_to_json(const Sweep& sweep, const SweepRow& row) {
  const VariantRun& run = row.run;
  Json errors{{"field", row.field_error_percent}};
  for (std::size_t m = 0; m < row.measure_error_percent.size(); ++m)
    errors[sweep.definition.measures[m].name] = row.measure_error_percent[m];
  return {
      {"method", method_name(row.variant)},
      {"cells", row.variant.cells},
      {"tolerance", row.variant.program == Program::calculix ? Json(nullptr) : Json(row.variant.tolerance)},
      {"status", cases::name_of(run.first.status)},
      {"message", run.first.message},
      {"unknowns", run.first.unknowns},
      {"rounds", run.first_seconds.size()},
      {"warm_up", run.is_warm},
      {"seconds",
       {{"setup", times(run.setup_seconds)},
        {"first", times(run.first_seconds)},
        {"again", times(run.again_seconds)}}},
      {"first", counters(run.first)},
      {"again", run.again.status == cases::Status::skipped ? Json(nullptr) : counters(run.again)},
      {"again_message", run.again.message},
      {"memory_MB", {{"start", run.start_megabytes}, {"peak", run.peak_megabytes}}},
      {"error_percent", errors}};
}

struct Picture {
  Error error;
  Clock clock;
  const char *name, *title;
};
constexpr Picture pictures[] = {
    {Error::field, Clock::first_answer, "field_first", "displacement field, first answer (setup and solve)"},
    {Error::field, Clock::re_solve, "field_again", "displacement field, re-solve after a load change of 5 %"},
    {Error::worst_measure, Clock::first_answer, "measures_first",
     "worst measure, first answer (setup and solve)"},
    {Error::worst_measure, Clock::re_solve, "measures_again",
     "worst measure, re-solve after a load change of 5 %"}};

/// The finite elements have linetype 1 (small strain), 7 (finite strain) and 8 (CalculiX), an element its
/// marker.
/// @param number  of the design among ours, or among those of others
Appearance appearance(const Variant& v, int number) {
  if (v.program == Program::springs) return appearance_of_springs(v.design, number);
  if (v.program == Program::calculix) return {8, 1 + static_cast<int>(v.formulation)};
  const int marker = v.element == cases::Element::q1 ? 4 : v.element == cases::Element::q1_bbar ? 6 : 12;
  return {v.formulation == cases::Formulation::small_strain ? 1 : 7, marker};
}

/// Points of the tightest tolerance are joined.
std::vector<Series> series_of(const Sweep& sweep, const Picture& picture) {
  std::vector<Series> all;
  std::array<int, 2> n_designs{}; // ours, and of others
  for (const std::string& method : methods_of(sweep)) {
    std::vector<const SweepRow*> rows;
    double tightest = 1;
    for (const SweepRow& row : sweep.rows) {
      if (method_name(row.variant) != method) continue;
      rows.push_back(&row);
      tightest = std::min(tightest, row.variant.tolerance);
    }
    const Variant& first = rows.front()->variant;
    int& n_alike = n_designs.at(cases::is_of_others(first.design) ? 1 : 0);
    Series series{method, appearance(first, n_alike)};
    if (first.program == Program::springs) {
      ++n_alike;
      series.floor = errors_by_level(sweep, method, picture.error).back();
    }
    for (const SweepRow* row : rows)
      if (const auto point = point_of(*row, picture.error, picture.clock))
        series.add(*point, row->variant.tolerance == tightest);
    if (!series.joined.empty() || !series.loose.empty()) all.push_back(series);
  }
  return all;
}

} // namespace

void write_sweep_text(std::ostream& out, const Sweep& sweep) {
  write_head(out, sweep);
  print(out, "  {:<34}{:>10} {:>6} {:>8} {:>3} {:>22} {:>22} {:>22} {:>4} {:>5} {:>4} {:>5} {:>7} {:>8}",
        "method", "cells", "tol.", "unknowns", "n", "setup, ms", "first solve, ms", "re-solve, ms", "New.",
        "CG", "fac.", "for.", "MB", "field %");
  for (const cases::Measure& measure : sweep.definition.measures) print(out, " {:>9}", measure.name + " %");
  print(out, "\n");
  for (const SweepRow& row : sweep.rows) write_row(out, row);
  write_reference(out, sweep);
  for (const LeftOut& left : sweep.plan.left_out) print(out, "left out: {}: {}\n", left.what, left.reason);
  for (const Conclusions& group : conclusions(sweep)) {
    print(out, "{}\n", group.heading);
    for (const std::string& sentence : group.sentences) print(out, "  {}\n", sentence);
  }
  print(out, "the sweep took {:.0f} s\n", sweep.seconds);
}

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

Json left_out_to_json(const std::vector<LeftOut>& left_out) {
  Json all = Json::array();
  for (const LeftOut& left : left_out) all.push_back({{"what", left.what}, {"reason", left.reason}});
  return all;
}

Json sweep_to_json(const Sweep& sweep) {
  Json document = provenance();
  document["case"] = sweep.definition.name;
  document["description"] = sweep.definition.description;
  document["settings"] = sweep.settings;
  document["threads"] = 1;
  document["ranks"] = sweep.n_ranks;
  document["own_process_per_variant"] = sweep.processes == Processes::one_per_variant;
  document["repetitions"] = sweep.rules.repetitions;
  document["budget_seconds"] = sweep.rules.budget_seconds;
  document["load_change"] = load_change;
  document["reference"] = reference_to_json(sweep);
  document["variants"] = Json::array();
  for (const SweepRow& row : sweep.rows) document["variants"].push_back(row_to_json(sweep, row));
  document["left_out"] = left_out_to_json(sweep.plan.left_out);
  document["conclusions"] = Json::array();
  for (const Conclusions& group : conclusions(sweep))
    document["conclusions"].push_back({{"heading", group.heading}, {"sentences", group.sentences}});
  document["seconds"] = sweep.seconds;
  return document;
}

void plot_sweep(const std::string& folder, const Sweep& sweep) {
  if (!sweep.reference) return;
  for (const Picture& picture : pictures) {
    ErrorPlot plot{picture.name,
                   picture.name + std::string(".csv"),
                   sweep.definition.name + ": " + picture.title,
                   "time",
                   "ms",
                   1e-3};
    plot.uncertainty = uncertainty_percent(*sweep.reference, picture.error);
    plot.series = series_of(sweep, picture);
    plot.points = points_of(sweep, picture.error, picture.clock);
    plot_errors(folder, plot); // which has no points of a case without measures, for one
  }
}

} // namespace springproof::compare
