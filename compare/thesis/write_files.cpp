#include "compare/thesis/write.hpp"

#include "compare/cube/write_design.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/table/table.hpp"
#include "compare/write/write.hpp"

#include <algorithm>
#include <cmath>

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
                cases::cell_volume(cases::cell_vertices(c.scene.mesh, cell)),
                side->solution.cell_volume[cell]);
}

Json group_to_json(const SummaryGroup& group, const std::vector<TableEntry>& entries) {
  const Json within = json_list(group.within, [](const Within& w) {
    return SPRINGPROOF_MEMBERS(w, bound, declared, other_only, neither);
  });
  const Json beyond = json_list(group.beyond, [&](const TableEntry* entry) -> Json {
    return {{"entry", entry - entries.data()},
            {"explanation", entry->finding.empty() ? "unexplained" : entry->finding}};
  });
  return {{"name", group.name},
          {"unit", group.unit},
          {"entries", group.n_entries},
          {"within", within},
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

void write_box_plot(std::ostream& out, const ThesisResults& results) {
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
  write_csv(out,
            columns_of("case model rest_mm3 total_mm3 total_change_percent rest_per_cell_mm3 "
                       "lower_whisker=whiskers.0 lower_quartile=quartiles.0 median=quartiles.1 "
                       "upper_quartile=quartiles.2 upper_whisker=whiskers.1 n_outliers outliers command"),
            rows, csv_digits);
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

} // namespace

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
