#include "compare/thesis/write_files.hpp"

#include "compare/provenance/whole_file.hpp"
#include "compare/thesis/write_json.hpp"
#include "compare/thesis/write_text.hpp"
#include "compare/write/csv.hpp"
#include "compare/write/write.hpp"

#include <nlohmann/json.hpp>

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
          "k_v_per_E", "small_worst_percent", "small_mean_percent", "small_volume_percent", "small_stable",
          "large_worst_percent", "large_mean_percent", "large_volume_percent", "large_stable", "reason",
          "command", "command_of_small_worst", "command_of_large_worst");
  for (const Advice& a : results.advice) {
    std::vector<std::optional<double>> k(4);
    if (a.stiffness)
      k = {a.stiffness->edge, a.stiffness->face_diagonal, a.stiffness->internal_diagonal,
           a.stiffness->volume};
    const LoadSetErrors &small = a.cube.small, &large = a.cube.large;
    csv.row(a.poissons_ratio, a.design, a.is_recommended, k, small.worst, small.mean, small.worst_volume,
            small.is_stable, large.worst, large.mean, large.worst_volume, large.is_stable, a.refusal(),
            a.trace.command, a.small_trace.command, a.large_trace.command);
  }
}

} // namespace

void write_thesis_files(const std::string& folder, const ThesisResults& results) {
  const auto file = [&](const std::string& name, const std::function<void(std::ostream&)>& write) {
    write_file(folder + "/" + name, write);
  };
  const auto csv_file = [&](const std::string& name, void (*write)(CsvWriter&, const ThesisResults&)) {
    file(name, [&](std::ostream& out) {
      CsvWriter csv(out);
      write(csv, results);
    });
  };
  file("tables.txt", [&](std::ostream& out) { write_tables_text(out, results, Commands::one_per_table); });
  file("tables.json", [&](std::ostream& out) { out << results_to_json(results).dump(2) << '\n'; });
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
