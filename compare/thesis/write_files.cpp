#include "compare/thesis/write_files.hpp"

#include "compare/cube/write_design.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/table/table.hpp"
#include "compare/thesis/write_audit.hpp"
#include "compare/thesis/write_text.hpp"
#include "compare/write/write.hpp"

#include <algorithm>
#include <cmath>

namespace springproof::compare {

namespace {

std::string joined(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, " "));
}

void write_tables(CsvWriter& csv, const ThesisResults& results) {
  csv.row("table", "material", "poissons_ratio", "design", "design_poissons_ratio", "load_set", "test",
          "measure", "published", "unit", "reference", "computed", "fem", "msm", "difference", "declared",
          "nearest", "from_beta_2", "from_printed_beta_2", "finding", "reason", "case", "settings",
          "command");
  for (const TableEntry& entry : results.entries)
    for (const ComputedFigure& c : entry.computed) {
      const PublishedFigure& p = entry.published;
      csv.row(p.table, p.material, p.poissons_ratio, p.design, p.design_poissons_ratio, p.load_set, p.test,
              p.measure, p.value, p.unit, c.reference, c.value, c.fem, c.msm, entry.difference(c),
              &c == &entry.declared(), &c == entry.nearest(), c.from_beta_2, c.from_printed_beta_2,
              entry.finding, c.reason, c.trace.case_file, joined(c.trace.settings), c.trace.command);
    }
}

void write_designs(CsvWriter& csv, const ThesisResults& results) {
  csv.row("table", "design", "figures", "missing", "mean_error_percent", "worst_error_percent", "worst_at",
          "reasons", "command_of_worst");
  for (const DesignRow& row : results.designs)
    csv.row(row.table, row.design, row.errors.n, row.n_missing, row.errors.mean(), row.errors.worst,
            row.worst_at, joined(row.reasons), row.worst_trace.command);
}

void write_volumes(CsvWriter& csv, const ThesisResults& results) {
  csv.row("case", "model", "cell", "rest_mm3", "deformed_mm3");
  for (const Comparison& c : results.cases)
    for (const auto& [model, side] : {std::pair("fem", &c.answers.fem), std::pair("msm", &c.answers.msm)})
      for (std::size_t cell = 0; cell < side->solution.cell_volume.size(); ++cell)
        csv.row(c.scene.definition.name, model, cell,
                cases::cell_volume(cases::cell_vertices(c.scene.mesh, cell)),
                side->solution.cell_volume[cell]);
}

void write_box_plot(CsvWriter& csv, const ThesisResults& results) {
  csv.row("case", "model", "rest_mm3", "total_mm3", "total_change_percent", "rest_per_cell_mm3",
          "lower_whisker", "lower_quartile", "median", "upper_quartile", "upper_whisker", "n_outliers",
          "outliers", "command");
  for (const CaseVolumes& v : results.volumes)
    for (const auto& [model, of_model] : {std::pair("fem", &v.fem), std::pair("msm", &v.msm)}) {
      if (!*of_model) continue;
      const auto& [total, b] = **of_model;
      std::vector<std::string> outliers;
      for (const double volume : b.outliers) outliers.push_back(fmt::format("{:.8g}", volume));
      csv.row(v.name, model, v.rest, total, (total / v.rest - 1) * 100, v.rest_per_cell, b.lower_whisker,
              b.lower_quartile, b.median, b.upper_quartile, b.upper_whisker, b.outliers.size(),
              joined(outliers), v.trace.command);
    }
}

void write_advice(CsvWriter& csv, const ThesisResults& results) {
  csv.row("poissons_ratio", "design", "recommended", "k_e_per_E_L0", "k_f_per_E_L0", "k_d_per_E_L0",
          "k_v_per_E", "p_e", "p_f", "p_d", "small_worst_percent", "small_mean_percent",
          "small_volume_percent", "small_stable", "large_worst_percent", "large_mean_percent",
          "large_volume_percent", "large_stable", "reason", "command", "command_of_small_worst",
          "command_of_large_worst");
  for (const Advice& a : results.advice) {
    std::vector<std::optional<double>> k(4), p(3);
    if (a.stiffness)
      k = {a.stiffness->edge, a.stiffness->face_diagonal, a.stiffness->internal_diagonal,
           a.stiffness->volume};
    if (a.stiffness && a.stiffness->exponents)
      p = {a.stiffness->exponents->edge, a.stiffness->exponents->face_diagonal,
           a.stiffness->exponents->internal_diagonal};
    const LoadSetErrors &small = a.cube.small, &large = a.cube.large;
    csv.row(a.poissons_ratio, a.design, a.is_recommended, k, p, small.worst, small.mean, small.worst_volume,
            small.is_stable, large.worst, large.mean, large.worst_volume, large.is_stable, a.refusal(),
            a.trace.command, a.small_trace.command, a.large_trace.command);
  }
}

Json text_or_null(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

Json entry_to_json(const TableEntry& entry) {
  const PublishedFigure& p = entry.published;
  const ComputedFigure& declared = entry.declared();
  Json other = Json::object(), other_command = Json::object();
  for (std::size_t k = 1; k < entry.computed.size(); ++k) {
    other[entry.computed[k].reference] = entry.computed[k].value;
    other_command[entry.computed[k].reference] = entry.computed[k].trace.command;
  }
  const ComputedFigure* nearest = entry.nearest();
  Json row{{"table", p.table},
           {"material", p.material},
           {"poissons_ratio", p.poissons_ratio},
           {"design", p.design},
           {"design_poissons_ratio", p.design_poissons_ratio},
           {"load_set", p.load_set},
           {"test", p.test},
           {"measure", p.measure},
           {"unit", p.unit},
           {"published", p.value},
           {"computed", declared.value},
           {"difference", entry.difference(declared)},
           {"reference", declared.reference},
           {"other", other},
           {"nearest", nearest ? Json(nearest->reference) : Json(nullptr)},
           {"fem", declared.fem},
           {"msm", declared.msm},
           {"finding", text_or_null(entry.finding)},
           {"reason", text_or_null(declared.reason)},
           {"case", text_or_null(declared.trace.case_file)},
           {"settings", declared.trace.settings},
           {"command", declared.trace.command},
           {"other_command", other_command}};
  if (p.measure == "beta_1") {
    row["from_beta_2"] = Json::object();
    for (const ComputedFigure& c : entry.computed) row["from_beta_2"][c.reference] = c.from_beta_2;
  }
  return row;
}

Json group_to_json(const SummaryGroup& group, const std::vector<TableEntry>& entries) {
  Json within = Json::array(), beyond = Json::array();
  for (const Within& w : group.within)
    within.push_back(
        {{"bound", w.bound}, {"declared", w.declared}, {"other_only", w.other_only}, {"neither", w.neither}});
  for (const TableEntry* entry : group.beyond)
    beyond.push_back({{"entry", entry - entries.data()},
                      {"explanation", entry->finding.empty() ? "unexplained" : entry->finding}});
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
    row["stiffness_per_E_L0"] = {a.stiffness->edge, a.stiffness->face_diagonal,
                                 a.stiffness->internal_diagonal};
    row["volume_stiffness_per_E"] = a.stiffness->volume;
    if (const auto& p = a.stiffness->exponents)
      row["exponents"] = {p->edge, p->face_diagonal, p->internal_diagonal};
  }
  row["small"]["command_of_worst"] = text_or_null(a.small_trace.command);
  row["large"]["command_of_worst"] = text_or_null(a.large_trace.command);
  return row;
}

template<class Record, class ToJson>
Json list(const std::vector<Record>& records, const ToJson& to_json) {
  Json rows = Json::array();
  for (const Record& record : records) rows.push_back(to_json(record));
  return rows;
}

} // namespace

Json results_to_json(const ThesisResults& results) {
  Json summary{{"entries", results.entries.size()}};
  for (const double points : {0.1, 0.5, 1.0, 2.0})
    summary[fmt::format("within_{:g}_points", points)] = count_nearest(results.entries, points);
  summary["groups"] = list(summarise(results.entries),
                           [&](const SummaryGroup& group) { return group_to_json(group, results.entries); });
  return {{"schema", 1},
          {"entries", list(results.entries, entry_to_json)},
          {"designs", list(results.designs, design_to_json)},
          {"volumes", list(results.volumes, volumes_to_json)},
          {"cell_volume_changes", list(results.cell_volume_changes, change_to_json)},
          {"advice", list(results.advice, advice_to_json)},
          {"summary", summary}};
}

void write_thesis_files(const std::string& folder, const ThesisResults& results) {
  const auto file = [&](const std::string& name, const std::function<void(std::ostream&)>& write) {
    write_file(folder + "/" + name, write);
  };
  const auto csv_file = [&](const std::string& name, void (*write)(CsvWriter&, const ThesisResults&)) {
    write_csv_file(folder + "/" + name, [&](CsvWriter& csv) { write(csv, results); });
  };
  file("tables.txt", [&](std::ostream& out) { write_tables_text(out, results); });
  file("audit.txt", [&](std::ostream& out) { write_audit_text(out, results); });
  file("tables.json", [&](std::ostream& out) { out << json_text(results_to_json(results)); });
  csv_file("tables.csv", write_tables);
  if (!results.designs.empty()) csv_file("designs.csv", write_designs);
  if (!results.advice.empty()) csv_file("advice.csv", write_advice);
  if (results.cases.empty()) return;
  csv_file("volumes.csv", write_volumes);
  csv_file("box_plot.csv", write_box_plot);
  for (const Comparison& comparison : results.cases)
    file(comparison.scene.definition.name + ".vtu", [&](std::ostream& out) { write_vtu(out, comparison); });
}

} // namespace springproof::compare
