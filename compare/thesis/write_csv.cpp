#include "compare/thesis/write.hpp"
#include "compare/write/csv.hpp"

#include <fmt/format.h>

namespace springproof::compare {

namespace {

std::string joined(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, " "));
}

void write_box(CsvWriter& csv, const CaseVolumes& volumes, const char* model, const ModelVolumes& v) {
  if (!v.total || !v.per_cell) return;
  const BoxPlot& b = *v.per_cell;
  std::vector<std::string> outliers;
  for (const double value : b.outliers) outliers.push_back(fmt::format("{:.8g}", value));
  csv.row(volumes.name, model, volumes.rest, *v.total, (*v.total / volumes.rest - 1) * 100,
          volumes.rest_per_cell, b.lower_whisker, b.lower_quartile, b.median, b.upper_quartile,
          b.upper_whisker, b.outliers.size(), joined(outliers), volumes.trace.command);
}

} // namespace

void write_tables_csv(std::ostream& out, const std::vector<TableEntry>& entries) {
  CsvWriter csv(out);
  csv.row("table", "material", "poissons_ratio", "design", "design_poissons_ratio", "load_set", "test",
          "measure", "published", "unit", "reference", "computed", "fem", "msm", "difference", "declared",
          "nearest", "from_beta_2", "from_printed_beta_2", "finding", "reason", "case", "settings",
          "command");
  for (const TableEntry& entry : entries)
    for (const ComputedFigure& c : entry.computed) {
      const PublishedFigure& p = entry.published;
      csv.row(p.table, p.material, p.poissons_ratio, p.design, p.design_poissons_ratio, p.load_set, p.test,
              p.measure, p.value, p.unit, c.reference, c.value, c.fem, c.msm, entry.difference(c),
              &c == &entry.declared(), &c == entry.nearest(), c.from_beta_2, c.from_printed_beta_2,
              entry.finding, c.reason, c.trace.case_file, joined(c.trace.settings), c.trace.command);
    }
}

void write_designs_csv(std::ostream& out, const std::vector<DesignRow>& rows) {
  CsvWriter csv(out);
  csv.row("table", "design", "figures", "missing", "mean_error_percent", "worst_error_percent", "worst_at",
          "reasons", "command_of_worst");
  for (const DesignRow& row : rows)
    csv.row(row.table, row.design, row.n_figures, row.n_missing, row.mean, row.worst, row.worst_at,
            joined(row.reasons), row.worst_trace.command);
}

void write_volumes_csv(std::ostream& out, const std::vector<Comparison>& cases) {
  CsvWriter csv(out);
  csv.row("case", "model", "cell", "rest_mm3", "deformed_mm3");
  for (const Comparison& c : cases)
    for (const auto& [model, side] : {std::pair("fem", &c.answers.fem), std::pair("msm", &c.answers.msm)})
      for (std::size_t cell = 0; cell < side->solution.cell_volume.size(); ++cell)
        csv.row(c.scene.definition.name, model, cell,
                cases::cell_volume(cases::cell_vertices(c.scene.mesh, cell)),
                side->solution.cell_volume[cell]);
}

void write_box_plot_csv(std::ostream& out, const std::vector<CaseVolumes>& volumes) {
  CsvWriter csv(out);
  csv.row("case", "model", "rest_mm3", "total_mm3", "total_change_percent", "rest_per_cell_mm3",
          "lower_whisker", "lower_quartile", "median", "upper_quartile", "upper_whisker", "n_outliers",
          "outliers", "command");
  for (const CaseVolumes& v : volumes) {
    write_box(csv, v, "fem", v.fem);
    write_box(csv, v, "msm", v.msm);
  }
}

void write_advice_csv(std::ostream& out, const std::vector<Advice>& advice) {
  CsvWriter csv(out);
  csv.row("poissons_ratio", "design", "recommended", "k_e_per_E_L0", "k_f_per_E_L0", "k_d_per_E_L0",
          "k_v_per_E", "small_worst_percent", "small_mean_percent", "small_volume_percent", "small_stable",
          "large_worst_percent", "large_mean_percent", "large_volume_percent", "large_stable", "reason",
          "command", "command_of_small_worst", "command_of_large_worst");
  for (const Advice& a : advice) {
    const auto stiffness = [&](double msm::CellStiffness::*kind) {
      return a.stiffness ? std::optional((*a.stiffness).*kind) : std::nullopt;
    };
    csv.row(a.poissons_ratio, a.design, a.is_recommended, stiffness(&msm::CellStiffness::edge),
            stiffness(&msm::CellStiffness::face_diagonal), stiffness(&msm::CellStiffness::internal_diagonal),
            stiffness(&msm::CellStiffness::volume), a.small.worst, a.small.mean, a.small.worst_volume,
            a.small.is_stable, a.large.worst, a.large.mean, a.large.worst_volume, a.large.is_stable,
            a.refusal, a.trace.command, a.small.trace.command, a.large.trace.command);
  }
}

} // namespace springproof::compare
