#include "compare/thesis/write.hpp"

#include "compare/thesis/layout.hpp"

#include <algorithm>
#include <fmt/ostream.h>
#include <functional>

namespace springproof::compare {

namespace {

/// Rows of one measure: each reference, print, the difference of the nearest, and what explains a beta_1.
void write_measure(std::ostream& out, const Sheet::Row& row) {
  const auto line = [&](const std::string& test, const std::string& measure, const std::string& label,
                        const std::function<std::string(const TableEntry&)>& cell) {
    fmt::print(out, "  {:<8} {:<18} {:<22}", test, measure, label);
    for (const TableEntry* entry : row.cells)
      fmt::print(out, " {:>16}", entry ? cell(*entry) : std::string());
    fmt::print(out, "\n");
  };
  const auto& [test, measure, cells, first] = row;
  const auto& references = first->computed;
  const int digits = digits_of(first->published);
  for (std::size_t k = 0; k < references.size(); ++k)
    line(k == 0 ? test : "", k == 0 ? measure : "", references[k].reference, [&](const TableEntry& entry) {
      const bool is_marked = references.size() > 1 && entry.nearest() == &entry.computed[k];
      return value_text(entry.computed[k].value, digits) + (is_marked ? "*" : "");
    });
  line("", "", measure == "beta_1" ? "published (!)" : "published",
       [&](const TableEntry& entry) { return value_text(entry.published.value, digits); });
  line("", "", "difference", [&](const TableEntry& entry) {
    const ComputedFigure* nearest = entry.nearest();
    return value_text(nearest ? entry.difference(*nearest) : std::nullopt, digits);
  });
  const bool has_large = std::any_of(cells.begin(), cells.end(), [](const TableEntry* entry) {
    return entry && entry->published.load_set == "large";
  });
  // It explains the large rows in print; of the small ones nothing does.
  if (measure == "beta_1" && has_large)
    line("", "", "45 deg + small beta_2", [&](const TableEntry& entry) {
      if (entry.published.load_set != "large") return std::string();
      const auto [reference, value] = nearest_from_beta_2(entry);
      return value_text(reference ? std::optional(value) : std::nullopt, digits);
    });
}

void write_commands(std::ostream& out, const Sheet& sheet) {
  for (const TableEntry* entry : sheet.entries)
    for (const ComputedFigure& c : entry->computed)
      fmt::print(out, "  {} ({}): {}\n", name_of(entry->published), c.reference, c.trace.command);
}

void write_sheet(std::ostream& out, const Sheet& sheet) {
  const bool has_two = sheet.entries.front()->computed.size() > 1;
  fmt::print(out, "\n{}: {}{}\n", name_of(sheet), subject_of(sheet),
             has_two ? "; first the declared reference; * the one nearer to print" : "");
  for (std::size_t part = 0; part < 3; ++part) {
    fmt::print(out, "  {:<8} {:<18} {:<22}", "", "", "");
    for (const auto& column : sheet.columns) fmt::print(out, " {:>16}", column[part]);
    fmt::print(out, "\n");
  }
  for (const Sheet::Row& row : sheet.rows) write_measure(out, row);
  const bool has_beta_1 = std::any_of(sheet.entries.begin(), sheet.entries.end(),
                                      [](const TableEntry* e) { return e->published.measure == "beta_1"; });
  if (has_beta_1)
    fmt::print(out,
               "  (!) the printed beta_1 is not the rotation that the text defines; ours is: see the end\n");
  for (const TableEntry* entry : sheet.entries)
    for (const ComputedFigure& c : entry->computed)
      if (!c.value)
        fmt::print(out, "  no value: {} {} nu = {:g} ({}): {}\n", entry->published.test,
                   entry->published.measure, entry->published.poissons_ratio, c.reference, c.reason);
  write_commands(out, sheet);
}

void write_model_volumes(std::ostream& out, const std::string& name, const char* model,
                         const std::optional<ModelVolumes>& v) {
  fmt::print(out, "  {:<28} {:<4}", name, model);
  if (!v) return fmt::print(out, " {:>10}\n", "-");
  const BoxPlot& b = v->per_cell;
  fmt::print(out, " {:>10.2f} {:>9.4f} {:>9.4f} {:>9.4f} {:>9.4f} {:>9.4f} {:>9}\n", v->total,
             b.lower_whisker, b.lower_quartile, b.median, b.upper_quartile, b.upper_whisker,
             b.outliers.size());
}

std::string worst_and_mean(const LoadSetErrors& errors) {
  if (!errors.worst) return "-";
  return fmt::format("{:.1f} ({:.1f}){}", *errors.worst, *errors.mean, errors.is_stable ? "" : " unstable");
}

std::string stiffness(const std::optional<msm::CellStiffness>& k) {
  if (!k) return fmt::format("{:>35}", "");
  return fmt::format("{:>8.4f} {:>8.4f}", fmt::join(k->springs(), " "), k->volume);
}

std::string exponents(const msm::CellStiffness& k) {
  if (!k.exponents) return "";
  return fmt::format(", exponents {:.3f}", fmt::join(k.exponents->by_kind, ", "));
}

/// A line that a reader with E and nu in hand can use as it stands.
void write_recommendation(std::ostream& out, const Advice& a) {
  const double youngs_modulus = 0.05;            // MPa, soft tissue
  const double per_metre = 1e3 * youngs_modulus; // N/m of a cell of 1 mm
  const auto& k = a.stiffness;
  const std::string stiffnesses =
      k ? fmt::format(
              ". E = 50 kPa, L0 = 1 mm: k_e, k_f, k_d = {:.2f}, {:.2f}, {:.2f} N/m, k_v = {:.5f} MPa{}",
              per_metre * k->edge, per_metre * k->face_diagonal, per_metre * k->internal_diagonal,
              youngs_modulus * k->volume, exponents(*k))
        : "";
  fmt::print(
      out,
      "  nu = {:g}: use {}{}; expect errors up to {:.1f} % under the small loads, {:.1f} % under the large "
      "ones, volume within {:.1f} %.\n      its {} again (E = 1 MPa): {}\n",
      a.poissons_ratio, a.design, stiffnesses, *a.cube.small.worst, *a.cube.large.worst,
      *a.cube.worst_volume(), k ? "stiffnesses" : "springs", a.trace.command);
  if (k)
    fmt::print(out, "      its worst errors again: {}\n      {}\n", a.small_trace.command,
               a.large_trace.command);
}

void write_beyond(std::ostream& out, const TableEntry& entry) {
  const PublishedFigure& p = entry.published;
  fmt::print(out, "    {} {} {} {} nu = {:g}, {}: published {:g};", p.table, p.load_set, p.test, p.measure,
             p.poissons_ratio, p.design, p.value);
  for (const ComputedFigure& c : entry.computed)
    fmt::print(
        out, " {} {}{};", c.reference,
        c.value ? fmt::format("{:.{}f}", *c.value, digits_of(p)) : "no value: ", c.value ? "" : c.reason);
  fmt::print(out, " {}\n", entry.finding.empty() ? "unexplained" : entry.finding);
}

void write_designs_text(std::ostream& out, const std::vector<DesignRow>& rows) {
  if (rows.empty()) return;
  fmt::print(
      out,
      "\nThe same tables with other designs: |error| against the declared reference, %. A method designs "
      "from the table's own material.\n  {:<6} {:<34} {:>8} {:>9} {:>9} {:>9}  {}\n",
      "table", "design", "figures", "missing", "mean", "worst", "where");
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const DesignRow& row = rows[r];
    fmt::print(out, "  {:<6} {:<34} {:>8} {:>9} {:>9} {:>9}  {}\n",
               r == 0 || rows[r - 1].table != row.table ? row.table : "", row.design, row.errors.n,
               row.n_missing, value_text(row.errors.mean()), value_text(row.errors.worst), row.worst_at);
    for (const std::string& reason : row.reasons) fmt::print(out, "         missing: {}\n", reason);
  }
}

void write_volumes_text(std::ostream& out, const std::vector<CaseVolumes>& volumes,
                        const std::vector<CellVolumeChange>& changes) {
  if (volumes.empty()) return;
  fmt::print(
      out,
      "\nVolumes, mm3: of the body, and of its cells as box plots (figure 5.10; whiskers at the outermost "
      "values within 1.5 times the interquartile range)\n"
      "  {:<28} {:<4} {:>10} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n",
      "case", "", "body", "whisker", "quartile", "median", "quartile", "whisker", "outliers");
  for (const CaseVolumes& v : volumes) {
    write_model_volumes(out, v.name, "fem", v.fem);
    write_model_volumes(out, "", "msm", v.msm);
  }
  for (const CellVolumeChange& change : changes)
    fmt::print(out, "  largest change of a cell without outliers, Ogden, {} loads: {} %, published {:g} %\n",
               change.load_set, value_text(change.computed), change.published);
}

void write_advice_text(std::ostream& out, const std::vector<Advice>& advice) {
  if (advice.empty()) return;
  fmt::print(out,
             "\nWhich design to use: stiffnesses for any E and L0 (k = figure x E L0, k_v = figure x E) and "
             "|error| on the thesis's cube, worst (mean), %, against the declared reference\n"
             "  {:<6} {:<17} {:>8} {:>8} {:>8} {:>8}   {:<22} {:<22}\n",
             "nu", "design", "k_e", "k_f", "k_d", "k_v", "small loads", "large loads");
  for (const Advice& a : advice)
    fmt::print(out, "{} {:<6g} {:<17} {}   {:<22} {:<22}{}\n", a.is_recommended ? ">" : " ", a.poissons_ratio,
               a.design, stiffness(a.stiffness), worst_and_mean(a.cube.small), worst_and_mean(a.cube.large),
               a.refusal());
  for (const Advice& a : advice)
    if (a.is_recommended) write_recommendation(out, a);
  fmt::print(out,
             "  Recommended is the smallest worst error over both sets among the designs that stay stable. "
             "The errors hold for equal strains: loads in proportion to E.\n");
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

} // namespace

void write_audit_text(std::ostream& out, const ThesisResults& results) {
  for (const Sheet& sheet : sheets_of(results.entries)) write_sheet(out, sheet);
  write_designs_text(out, results.designs);
  write_volumes_text(out, results.volumes, results.cell_volume_changes);
  write_advice_text(out, results.advice);
  write_summary_text(out, summarise(results.entries));
}

} // namespace springproof::compare
