#include "compare/thesis/write.hpp"

#include "compare/cube/write_design.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/table/table.hpp"
#include "compare/write/write.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/ostream.h>

namespace springproof::compare {

namespace {

constexpr int csv_digits = 8;

/// A printed figure beside what one reference gives for it; the document fills in what the others give.
Json figure_to_json(const TableEntry& entry, const ComputedFigure& c) {
  Json row = SPRINGPROOF_MEMBERS(entry.published, table, material, poissons_ratio, design,
                                 design_poissons_ratio, load_set, test, measure, unit);
  row.update({{"published", entry.published.value},
              {"computed", c.value},
              {"difference", entry.difference(c)},
              {"reference", c.reference},
              {"other", nullptr},
              {"nearest", &c == entry.nearest()},
              {"fem", c.fem},
              {"msm", c.msm},
              {"finding", text_or_null(entry.finding)},
              {"reason", text_or_null(c.reason)},
              {"case", text_or_null(c.trace.case_file)},
              {"settings", c.trace.settings},
              {"command", c.trace.command}});
  return row;
}

/// A figure with all its references: the declared one, and the others by name.
Json entry_to_json(const TableEntry& entry) {
  Json row = figure_to_json(entry, entry.declared()), values = Json::object(), commands = values,
       readings = values;
  for (const ComputedFigure& c : entry.computed) {
    readings[c.reference] = c.from_beta_2;
    if (&c == &entry.declared()) continue;
    values[c.reference] = c.value;
    commands[c.reference] = c.trace.command;
  }
  const ComputedFigure* nearest = entry.nearest();
  row.update({{"other", values},
              {"nearest", nearest ? Json(nearest->reference) : Json(nullptr)},
              {"other_command", commands}});
  if (entry.published.measure == "beta_1") row["from_beta_2"] = readings;
  return row;
}

void write_tables(std::ostream& out, const ThesisResults& results) {
  Json rows = Json::array();
  for (const TableEntry& entry : results.entries)
    for (const ComputedFigure& c : entry.computed) {
      rows.push_back(figure_to_json(entry, c));
      rows.back()["declared"] = &c == &entry.declared();
      rows.back().update(SPRINGPROOF_MEMBERS(c, from_beta_2, from_printed_beta_2));
    }
  write_csv(
      out,
      columns_of("table material poissons_ratio design design_poissons_ratio load_set test measure published "
                 "unit reference computed fem msm difference declared nearest from_beta_2 "
                 "from_printed_beta_2 finding reason case settings command"),
      rows, csv_digits);
}

void write_volumes(std::ostream& out, const ThesisResults& results) {
  CsvWriter csv(out, csv_digits);
  csv.row("case", "model", "cell", "rest_mm3", "deformed_mm3");
  for (const Comparison& c : results.cases)
    for (const auto& [model, side] : {std::pair("fem", &c.answers.fem), std::pair("msm", &c.answers.msm)})
      for (std::size_t cell = 0; cell < side->solution.cell_volume.size(); ++cell)
        csv.row(c.scene.definition.name, model, cell,
                cases::cell_volume(cases::cell_corners(c.scene.mesh, cell)),
                side->solution.cell_volume[cell]);
}

std::string finding_of(const TableEntry& entry) {
  return entry.finding.empty() ? "unexplained" : entry.finding;
}

Json within_to_json(const SummaryGroup& group) {
  return json_list(group.within, [](const Within& w) {
    return SPRINGPROOF_MEMBERS(w, bound, declared, other_only, neither);
  });
}

Json group_to_json(const SummaryGroup& group, const std::vector<TableEntry>& entries) {
  const Json beyond = json_list(group.beyond, [&](const TableEntry* entry) -> Json {
    return {{"entry", entry - entries.data()}, {"explanation", finding_of(*entry)}};
  });
  return {{"name", group.name},
          {"unit", group.unit},
          {"entries", group.n_entries},
          {"within", within_to_json(group)},
          {"listing_bound", group.listing_bound},
          {"beyond", beyond}};
}

/// Errors, beta_1 among them, that the nearest reference brings within so many points.
auto count_nearest(const std::vector<TableEntry>& entries, double points) {
  return std::count_if(entries.begin(), entries.end(), [&](const TableEntry& entry) {
    const ComputedFigure* nearest = entry.nearest();
    return entry.published.unit == "%" && nearest && std::abs(*entry.difference(*nearest)) <= points;
  });
}

Json design_to_json(const DesignRow& row) {
  return {{"table", row.table},
          {"design", row.design},
          {"figures", row.errors.n},
          {"missing", row.n_missing},
          {"mean_error_percent", row.errors.mean()},
          {"worst_error_percent", row.errors.worst},
          {"worst_at", row.worst_at},
          {"reasons", row.reasons},
          {"command_of_worst", text_or_null(row.worst_trace.command)}};
}

Json box_to_json(const std::optional<ModelVolumes>& v) {
  if (!v) return nullptr;
  const BoxPlot& b = v->per_cell;
  return {{"total_mm3", v->total},
          {"quartiles", {b.lower_quartile, b.median, b.upper_quartile}},
          {"whiskers", {b.lower_whisker, b.upper_whisker}},
          {"outliers", b.outliers}};
}

Json volumes_to_json(const CaseVolumes& v) {
  return {{"case", v.name},
          {"rest_mm3", v.rest},
          {"rest_per_cell_mm3", v.rest_per_cell},
          {"fem", box_to_json(v.fem)},
          {"msm", box_to_json(v.msm)},
          {"command", v.trace.command}};
}

Json change_to_json(const CellVolumeChange& change) {
  return {{"load_set", change.load_set},
          {"published_percent", change.published},
          {"computed_percent", change.computed}};
}

Json advice_to_json(const Advice& a) {
  Json row{{"poissons_ratio", a.poissons_ratio},    {"design", a.design},
           {"recommended", a.is_recommended},       {"designed", a.is_designed},
           {"stiffness_per_E_L0", nullptr},         {"volume_stiffness_per_E", nullptr},
           {"small", errors_to_json(a.cube.small)}, {"large", errors_to_json(a.cube.large)},
           {"reason", text_or_null(a.refusal())},   {"command", a.trace.command}};
  if (a.stiffness) {
    row["stiffness_per_E_L0"] = a.stiffness->springs();
    row["volume_stiffness_per_E"] = a.stiffness->volume;
    if (const auto& p = a.stiffness->exponents) row["exponents"] = p->by_kind;
  }
  row["small"]["command_of_worst"] = text_or_null(a.small_trace.command);
  row["large"]["command_of_worst"] = text_or_null(a.large_trace.command);
  return row;
}

void write_designs(std::ostream& out, const ThesisResults& results) {
  write_csv(out,
            columns_of("table design figures missing mean_error_percent worst_error_percent worst_at reasons "
                       "command_of_worst"),
            json_list(results.designs, design_to_json), csv_digits);
}

/// A row for every model that was solved.
Json box_plots(const ThesisResults& results) {
  Json rows = Json::array();
  for (const CaseVolumes& v : results.volumes)
    for (const char* model : {"fem", "msm"}) {
      Json row = volumes_to_json(v);
      const Json box = row[model];
      if (box.is_null()) continue;
      row.update(box);
      row.update({{"model", model},
                  {"total_change_percent", (box["total_mm3"].get<double>() / v.rest - 1) * 100},
                  {"n_outliers", box["outliers"].size()}});
      rows.push_back(row);
    }
  return rows;
}

void write_box_plot(std::ostream& out, const ThesisResults& results) {
  write_csv(out,
            columns_of("case model rest_mm3 total_mm3 total_change_percent rest_per_cell_mm3 "
                       "lower_whisker=whiskers.0 lower_quartile=quartiles.0 median=quartiles.1 "
                       "upper_quartile=quartiles.2 upper_whisker=whiskers.1 n_outliers outliers command"),
            box_plots(results), csv_digits);
}

void write_advice(std::ostream& out, const ThesisResults& results) {
  std::string columns = "poissons_ratio design recommended k_e_per_E_L0=stiffness_per_E_L0.0 "
                        "k_f_per_E_L0=stiffness_per_E_L0.1 k_d_per_E_L0=stiffness_per_E_L0.2 "
                        "k_v_per_E=volume_stiffness_per_E p_e=exponents.0 p_f=exponents.1 p_d=exponents.2 ";
  for (const char* loads : {"small", "large"})
    columns +=
        fmt::format("{0}_worst_percent={0}.worst_error_percent {0}_mean_percent={0}.mean_error_percent "
                    "{0}_volume_percent={0}.worst_volume_error_percent {0}_stable={0}.stable ",
                    loads);
  write_csv(out,
            columns_of(columns + "reason command command_of_small_worst=small.command_of_worst "
                                 "command_of_large_worst=large.command_of_worst"),
            json_list(results.advice, advice_to_json), csv_digits);
}

void write_designs_text(std::ostream& out, const std::vector<DesignRow>& designs) {
  if (designs.empty()) return;
  fmt::print(out, "\nThe same tables with other designs: |error| against the declared reference, %. A method "
                  "designs from the table's own material.\n");
  write_table(out,
              columns_of("table design{:<} figures missing mean=mean_error_percent{:.2f} "
                         "worst=worst_error_percent{:.2f} where=worst_at{:<}"),
              json_list(designs, design_to_json));
  for (const DesignRow& row : designs)
    for (const std::string& reason : row.reasons)
      fmt::print(out, "  missing: {} {}: {}\n", row.table, row.design, reason);
}

void write_volumes_text(std::ostream& out, const ThesisResults& results) {
  if (results.volumes.empty()) return;
  fmt::print(out, "\nVolumes, mm3: of the body, and of its cells as box plots (figure 5.10; whiskers at the "
                  "outermost values within 1.5 times the interquartile range)\n");
  write_table(
      out,
      columns_of("case model{:<} body=total_mm3{:.2f} whisker=whiskers.0{:.4f} quartile=quartiles.0{:.4f} "
                 "median=quartiles.1{:.4f} quartile=quartiles.2{:.4f} whisker=whiskers.1{:.4f} "
                 "outliers=n_outliers"),
      box_plots(results));
  for (const CellVolumeChange& change : results.cell_volume_changes)
    fmt::print(out, "  largest change of a cell without outliers, Ogden, {} loads: {} %, published {:g} %\n",
               change.load_set, value_text(change.computed), change.published);
}

std::string worst_and_mean(const LoadSetErrors& errors) {
  if (!errors.worst) return "-";
  return fmt::format("{:.1f} ({:.1f}){}", *errors.worst, *errors.mean, errors.is_stable ? "" : " unstable");
}

/// A line that a reader with E and nu in hand can use as it stands.
void write_recommendation(std::ostream& out, const Advice& a) {
  const double youngs_modulus = 0.05; // MPa, soft tissue; of a cell of 1 mm
  std::string springs;
  if (const auto& k = a.stiffness)
    springs = ". E = 50 kPa, L0 = 1 mm: " + stiffness_text(scaled(*k, youngs_modulus));
  fmt::print(
      out,
      "  nu = {:g}: use {}{}; expect errors up to {:.1f} % under the small loads, {:.1f} % under the large "
      "ones, volume within {:.1f} %.\n      its {} again (E = 1 MPa): {}\n",
      a.poissons_ratio, a.design, springs, *a.cube.small.worst, *a.cube.large.worst, *a.cube.worst_volume(),
      a.stiffness ? "stiffnesses" : "springs", a.trace.command);
  if (a.stiffness)
    fmt::print(out, "      its worst errors again: {}\n      {}\n", a.small_trace.command,
               a.large_trace.command);
}

void write_advice_text(std::ostream& out, const std::vector<Advice>& advice) {
  if (advice.empty()) return;
  fmt::print(out, "\nWhich design to use: stiffnesses for any E and L0 (k = figure x E L0, k_v = figure x E) "
                  "and |error| on the thesis's cube, worst (mean), %, against the declared reference\n");
  write_table(out,
              columns_of("=mark nu=poissons_ratio{:g} design{:<} k_e=stiffness_per_E_L0.0{:.4f} "
                         "k_f=stiffness_per_E_L0.1{:.4f} k_d=stiffness_per_E_L0.2{:.4f} "
                         "k_v=volume_stiffness_per_E{:.4f} small~loads{:<} large~loads{:<} =refusal{:<}"),
              json_list(advice, [](const Advice& a) {
                Json row = advice_to_json(a);
                row.update({{"mark", a.is_recommended ? ">" : ""},
                            {"small loads", worst_and_mean(a.cube.small)},
                            {"large loads", worst_and_mean(a.cube.large)},
                            {"refusal", a.refusal()}});
                return row;
              }));
  for (const Advice& a : advice)
    if (a.is_recommended) write_recommendation(out, a);
  fmt::print(out,
             "  Recommended is the smallest worst error over both sets among the designs that stay stable. "
             "The errors hold for equal strains: loads in proportion to E.\n");
}

void write_beyond(std::ostream& out, const SummaryGroup& group) {
  if (group.beyond.empty()) return;
  fmt::print(out, "  {}: by neither within {:g}{}{}\n", group.name, group.listing_bound,
             group.unit.empty() ? "" : " ", group.unit);
  for (const TableEntry* entry : group.beyond) {
    const PublishedFigure& p = entry->published;
    fmt::print(out, "    {} {}: published {:g};", p.table, name_of(p), p.value);
    for (const ComputedFigure& c : entry->computed)
      fmt::print(out, " {} {};", c.reference,
                 c.value ? value_text(c.value, digits_of(p)) : "no value: " + c.reason);
    fmt::print(out, " {}\n", finding_of(*entry));
  }
}

void write_summary_text(std::ostream& out, const std::vector<SummaryGroup>& groups) {
  fmt::print(out, "\nSummary: published figures that are reproduced\n");
  Json rows = Json::array();
  for (const SummaryGroup& group : groups)
    for (Json row : within_to_json(group)) {
      row.update({{"name", group.name}, {"figures", group.n_entries}, {"unit", group.unit}});
      rows.push_back(row);
    }
  write_table(out,
              columns_of("=name figures within=bound{:g} =unit{:<} by~the~declared~reference=declared "
                         "only~by~the~other=other_only by~neither=neither"),
              rows);
  for (const SummaryGroup& group : groups) write_beyond(out, group);
}

} // namespace

void write_audit_text(std::ostream& out, const ThesisResults& results) {
  for (const Sheet& sheet : sheets_of(results.entries)) write_sheet(out, sheet);
  write_designs_text(out, results.designs);
  write_volumes_text(out, results);
  write_advice_text(out, results.advice);
  write_summary_text(out, summarise(results.entries));
}

Json results_to_json(const ThesisResults& results) {
  Json summary{{"entries", results.entries.size()}};
  for (const double points : {0.1, 0.5, 1.0, 2.0})
    summary[fmt::format("within_{:g}_points", points)] = count_nearest(results.entries, points);
  summary["groups"] = json_list(summarise(results.entries), [&](const SummaryGroup& group) {
    return group_to_json(group, results.entries);
  });
  return {{"schema", 1},
          {"entries", json_list(results.entries, entry_to_json)},
          {"designs", json_list(results.designs, design_to_json)},
          {"volumes", json_list(results.volumes, volumes_to_json)},
          {"cell_volume_changes", json_list(results.cell_volume_changes, change_to_json)},
          {"advice", json_list(results.advice, advice_to_json)},
          {"summary", summary}};
}

void write_thesis_files(const std::string& folder, const ThesisResults& results) {
  const auto file = [&](const std::string& name, const auto& write) {
    write_file(folder + "/" + name, [&](std::ostream& out) { write(out, results); });
  };
  file("tables.txt", write_tables_text);
  file("audit.txt", write_audit_text);
  write_json_file(folder + "/tables.json", results_to_json(results));
  file("tables.csv", write_tables);
  if (!results.designs.empty()) file("designs.csv", write_designs);
  if (!results.advice.empty()) file("advice.csv", write_advice);
  if (results.cases.empty()) return;
  file("volumes.csv", write_volumes);
  file("box_plot.csv", write_box_plot);
  for (const Comparison& comparison : results.cases)
    write_file(folder + "/" + comparison.scene.definition.name + ".vtu",
               [&](std::ostream& out) { write_vtu(out, comparison); });
}

} // namespace springproof::compare
