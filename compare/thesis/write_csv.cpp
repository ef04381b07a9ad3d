#include "compare/thesis/write.hpp"
#include "compare/write/csv.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

namespace springproof::compare {

namespace {

std::string field(const std::optional<double>& value) {
  return csv_number(value, 8);
}

std::string joined(const std::vector<std::string>& words) {
  return csv_text(fmt::format("{}", fmt::join(words, " ")));
}

void write_box(std::ostream& out, const CaseVolumes& volumes, const char* model, const ModelVolumes& v) {
  if (!v.total || !v.per_cell) return;
  const BoxPlot& b = *v.per_cell;
  std::vector<std::string> outliers;
  for (const double value : b.outliers) outliers.push_back(fmt::format("{:.8g}", value));
  fmt::print(out, "{},{},{:.8g},{:.8g},{:.8g},{:.8g},{:.8g},{:.8g},{:.8g},{:.8g},{:.8g},{},{},{}\n",
             csv_text(volumes.name), model, volumes.rest, *v.total, (*v.total / volumes.rest - 1) * 100,
             volumes.rest_per_cell, b.lower_whisker, b.lower_quartile, b.median, b.upper_quartile,
             b.upper_whisker, b.outliers.size(), fmt::join(outliers, " "), csv_text(volumes.trace.command));
}

} // namespace

void write_tables_csv(std::ostream& out, const std::vector<TableEntry>& entries) {
  fmt::print(
      out, "table,material,poissons_ratio,design,design_poissons_ratio,load_set,test,measure,published,unit,"
           "reference,computed,fem,msm,difference,declared,nearest,from_beta_2,from_printed_beta_2,finding,"
           "reason,case,settings,"
           "command\n");
  for (const TableEntry& entry : entries)
    for (const ComputedFigure& c : entry.computed) {
      const PublishedFigure& p = entry.published;
      fmt::print(out, "{},{},{:g},{},{:g},{},{},{},{:g},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n",
                 p.table, p.material, p.poissons_ratio, p.design, p.design_poissons_ratio, p.load_set, p.test,
                 p.measure, p.value, p.unit, c.reference, field(c.value), field(c.fem), field(c.msm),
                 field(entry.difference(c)), &c == &entry.declared() ? 1 : 0, &c == entry.nearest() ? 1 : 0,
                 field(c.from_beta_2), field(c.from_printed_beta_2), csv_text(entry.finding),
                 csv_text(c.reason), c.trace.case_file, joined(c.trace.settings), csv_text(c.trace.command));
    }
}

void write_designs_csv(std::ostream& out, const std::vector<DesignRow>& rows) {
  fmt::print(out, "table,design,figures,missing,mean_error_percent,worst_error_percent,worst_at,reasons,"
                  "command_of_worst\n");
  for (const DesignRow& row : rows)
    fmt::print(out, "{},{},{},{},{},{},{},{},{}\n", row.table, csv_text(row.design), row.n_figures,
               row.n_missing, field(row.mean), field(row.worst), csv_text(row.worst_at), joined(row.reasons),
               csv_text(row.worst_trace.command));
}

void write_volumes_csv(std::ostream& out, const std::vector<Comparison>& cases) {
  fmt::print(out, "case,model,cell,rest_mm3,deformed_mm3\n");
  for (const Comparison& c : cases)
    for (const auto& [model, side] : {std::pair("fem", &c.answers.fem), std::pair("msm", &c.answers.msm)})
      for (std::size_t cell = 0; cell < side->solution.cell_volume.size(); ++cell)
        fmt::print(out, "{},{},{},{:.8g},{:.8g}\n", csv_text(c.scene.definition.name), model, cell,
                   cases::cell_volume(cases::cell_vertices(c.scene.mesh, cell)),
                   side->solution.cell_volume[cell]);
}

void write_box_plot_csv(std::ostream& out, const std::vector<CaseVolumes>& volumes) {
  fmt::print(
      out,
      "case,model,rest_mm3,total_mm3,total_change_percent,rest_per_cell_mm3,lower_whisker,lower_quartile,"
      "median,upper_quartile,upper_whisker,n_outliers,outliers,command\n");
  for (const CaseVolumes& v : volumes) {
    write_box(out, v, "fem", v.fem);
    write_box(out, v, "msm", v.msm);
  }
}

void write_advice_csv(std::ostream& out, const std::vector<Advice>& advice) {
  fmt::print(out,
             "poissons_ratio,design,recommended,k_e_per_E_L0,k_f_per_E_L0,k_d_per_E_L0,k_v_per_E,"
             "small_worst_percent,small_mean_percent,small_volume_percent,small_stable,large_worst_percent,"
             "large_mean_percent,large_volume_percent,large_stable,reason,command,command_of_small_worst,"
             "command_of_large_worst\n");
  for (const Advice& a : advice) {
    const auto stiffness = [&](double msm::CellStiffness::*kind) {
      return field(a.stiffness ? std::optional((*a.stiffness).*kind) : std::nullopt);
    };
    fmt::print(out, "{:g},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", a.poissons_ratio,
               a.design, a.is_recommended ? 1 : 0, stiffness(&msm::CellStiffness::edge),
               stiffness(&msm::CellStiffness::face_diagonal),
               stiffness(&msm::CellStiffness::internal_diagonal), stiffness(&msm::CellStiffness::volume),
               field(a.small.worst), field(a.small.mean), field(a.small.worst_volume),
               a.small.is_stable ? 1 : 0, field(a.large.worst), field(a.large.mean),
               field(a.large.worst_volume), a.large.is_stable ? 1 : 0, csv_text(a.refusal),
               csv_text(a.trace.command), csv_text(a.small.trace.command), csv_text(a.large.trace.command));
  }
}

} // namespace springproof::compare
