#include "compare/thesis/write.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ostream.h>

namespace springproof::compare {

namespace {

std::string number(const std::optional<double>& value) {
  return value ? fmt::format("{:.2f}", *value) : "-";
}

void write_model_volumes(std::ostream& out, const std::string& name, const char* model,
                         const ModelVolumes& v) {
  if (!v.total || !v.per_cell) {
    fmt::print(out, "  {:<28} {:<4} {:>10}\n", name, model, "-");
    return;
  }
  const BoxPlot& b = *v.per_cell;
  fmt::print(out, "  {:<28} {:<4} {:>10.2f} {:>9.4f} {:>9.4f} {:>9.4f} {:>9.4f} {:>9.4f} {:>9}\n", name,
             model, *v.total, b.lower_whisker, b.lower_quartile, b.median, b.upper_quartile, b.upper_whisker,
             b.outliers.size());
}

std::string worst_and_mean(const Advice::Errors& errors) {
  if (!errors.worst) return "-";
  return fmt::format("{:.1f} ({:.1f}){}", *errors.worst, *errors.mean, errors.is_stable ? "" : " UNSTABLE");
}

void write_stiffness(std::ostream& out, const msm::CellStiffness& k) {
  fmt::print(out, " {:>8.4f} {:>8.4f} {:>8.4f} {:>8.4f}", k.edge, k.face_diagonal, k.internal_diagonal,
             k.volume);
}

/// A line that a reader with E and nu in hand can use as it stands.
void write_recommendation(std::ostream& out, const Advice& a) {
  const double youngs_modulus = 0.05; // MPa, soft tissue
  const msm::CellStiffness& k = *a.stiffness;
  const double to_newton_per_metre = 1e3 * youngs_modulus; // of a cell of 1 mm
  fmt::print(
      out,
      "  nu = {:g}: use {}. E = 50 kPa, L0 = 1 mm: k_e, k_f, k_d = {:.2f}, {:.2f}, {:.2f} N/m, k_v = "
      "{:.5f} MPa; expect errors up to {:.1f} % under the small loads, {:.1f} % under the large ones, volume "
      "within {:.1f} %.\n",
      a.poissons_ratio, a.design, to_newton_per_metre * k.edge, to_newton_per_metre * k.face_diagonal,
      to_newton_per_metre * k.internal_diagonal, youngs_modulus * k.volume, *a.small.worst, *a.large.worst,
      std::max(*a.small.worst_volume, *a.large.worst_volume));
  fmt::print(out, "      its stiffnesses again (E = 1 MPa): {}\n      its worst errors again: {}\n      {}\n",
             a.trace.command, a.small.trace.command, a.large.trace.command);
}

void write_beyond(std::ostream& out, const TableEntry& entry) {
  const PublishedFigure& p = entry.published;
  fmt::print(out, "    {} {} {} {} nu = {:g}, {}: published {:g};", p.table, p.load_set, p.test, p.measure,
             p.poissons_ratio, p.design, p.value);
  for (const ComputedFigure& c : entry.computed)
    fmt::print(out, " {} {}{};", c.reference,
               c.value ? fmt::format(p.test == "cell" ? "{:.4f}" : "{:.2f}", *c.value) : "no value: ",
               c.value ? "" : c.reason);
  fmt::print(out, " {}\n", entry.finding.empty() ? "unexplained" : entry.finding);
}

} // namespace

void write_designs_text(std::ostream& out, const std::vector<DesignRow>& rows) {
  if (rows.empty()) return;
  fmt::print(out,
             "\nThe same tables with other designs: |error| against the declared reference, %. A method "
             "designs from "
             "the table's own material.\n  {:<6} {:<34} {:>8} {:>9} {:>9} {:>9}  {}\n",
             "table", "design", "figures", "missing", "mean", "worst", "where");
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const DesignRow& row = rows[r];
    fmt::print(out, "  {:<6} {:<34} {:>8} {:>9} {:>9} {:>9}  {}\n",
               r == 0 || rows[r - 1].table != row.table ? row.table : "", row.design, row.n_figures,
               row.n_missing, number(row.mean), number(row.worst), row.worst_at);
    for (const std::string& reason : row.reasons) fmt::print(out, "         missing: {}\n", reason);
  }
}

void write_volumes_text(std::ostream& out, const std::vector<CaseVolumes>& volumes,
                        const std::vector<CellVolumeChange>& changes) {
  if (volumes.empty()) return;
  fmt::print(
      out,
      "\nVolumes, mm3: of the body, and of its cells as box plots (figure 5.10; whiskers at the outermost "
      "values within 1.5 times the interquartile range)\n  {:<28} {:<4} {:>10} {:>9} {:>9} {:>9} {:>9} "
      "{:>9} {:>9}\n",
      "case", "", "body", "whisker", "quartile", "median", "quartile", "whisker", "outliers");
  for (const CaseVolumes& v : volumes) {
    write_model_volumes(out, v.name, "fem", v.fem);
    write_model_volumes(out, "", "msm", v.msm);
  }
  for (const CellVolumeChange& change : changes)
    fmt::print(out, "  largest change of a cell without outliers, Ogden, {} loads: {} %, published {:g} %\n",
               change.load_set, number(change.computed), change.published);
}

void write_advice_text(std::ostream& out, const std::vector<Advice>& advice) {
  if (advice.empty()) return;
  fmt::print(out,
             "\nWhich design to use: stiffnesses for any E and L0 (k = figure x E L0, k_v = figure x E) and "
             "|error| on "
             "the thesis's cube, worst (mean), %, against the declared reference\n"
             "  {:<6} {:<17} {:>8} {:>8} {:>8} {:>8}   {:<22} {:<22}\n",
             "nu", "design", "k_e", "k_f", "k_d", "k_v", "small loads", "large loads");
  for (const Advice& a : advice) {
    fmt::print(out, "{} {:<6g} {:<17}", a.is_recommended ? ">" : " ", a.poissons_ratio, a.design);
    if (a.stiffness)
      write_stiffness(out, *a.stiffness);
    else
      fmt::print(out, " {:>35}", "");
    fmt::print(out, "   {:<22} {:<22}{}\n", worst_and_mean(a.small), worst_and_mean(a.large), a.refusal);
  }
  for (const Advice& a : advice)
    if (a.is_recommended) write_recommendation(out, a);
  fmt::print(out, "  Recommended is the smallest worst error over both sets among the designs that stay "
                  "stable. The errors hold "
                  "for equal strains: loads in proportion to E.\n");
}

void write_summary_text(std::ostream& out, const std::vector<SummaryGroup>& groups) {
  fmt::print(out, "\nSummary: published figures that are reproduced\n");
  for (const SummaryGroup& group : groups) {
    fmt::print(out, "  {}: {} figures\n", group.name, group.n_entries);
    for (const Within& w : group.within)
      fmt::print(out,
                 "    within {:<6g} {:<6}  {:>3} by the declared reference, {:>3} only by the other, {:>3} "
                 "by neither\n",
                 w.bound, group.unit, w.declared, w.other_only, w.neither);
    if (group.beyond.empty()) continue;
    fmt::print(out, "    by neither within {:g}{}{}:\n", group.listing_bound, group.unit.empty() ? "" : " ",
               group.unit);
    for (const TableEntry* entry : group.beyond) write_beyond(out, *entry);
  }
}

} // namespace springproof::compare
