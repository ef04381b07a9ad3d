#include "compare/thesis/sheet.hpp"
#include "compare/thesis/write.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ostream.h>

namespace springproof::compare {

namespace {

std::string number(const std::optional<double>& value, const PublishedFigure& figure) {
  if (!value) return "-";
  const int digits = figure.test == "cell" ? 4 : 2;
  const std::string text = fmt::format("{:.{}f}", *value, digits);
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  return is_zero ? fmt::format("{:.{}f}", 0.0, digits) : text; // never "-0.00"
}

std::string title(const Sheet& sheet) {
  const bool has_two = sheet.entries.front()->computed.size() > 1;
  return fmt::format("{}: {}{}", name_of(sheet), subject_of(sheet),
                     has_two ? "; first the declared reference; * the one nearer to print" : "");
}

/// Rows of one measure: each reference, print, the difference of the nearest, and what explains a beta_1.
class MeasureRows {
 public:
  MeasureRows(std::ostream& out, const Sheet& sheet, std::size_t row) : out_(out), sheet_(sheet), row_(row) {}

  void write() const {
    const auto& [test, measure] = sheet_.rows[row_];
    const auto& references = sheet_.first_of_row(row_)->computed;
    for (std::size_t k = 0; k < references.size(); ++k)
      line(k == 0 ? test : "", k == 0 ? measure : "", references[k].reference, [&](const TableEntry& entry) {
        const bool is_marked = references.size() > 1 && entry.nearest() == &entry.computed[k];
        return number(entry.computed[k].value, entry.published) + (is_marked ? "*" : "");
      });
    line("", "", measure == "beta_1" ? "published (!)" : "published",
         [](const TableEntry& entry) { return number(entry.published.value, entry.published); });
    line("", "", "difference", [](const TableEntry& entry) {
      const ComputedFigure* nearest = entry.nearest();
      return number(nearest ? entry.difference(*nearest) : std::nullopt, entry.published);
    });
    const bool has_large = std::any_of(sheet_.columns.begin(), sheet_.columns.end(),
                                       [](const auto& c) { return c[2] == "large"; });
    // It explains the large rows in print; of the small ones nothing does.
    if (measure == "beta_1" && has_large)
      line("", "", "45 deg + small beta_2", [](const TableEntry& entry) {
        if (entry.published.load_set != "large") return std::string();
        return number(nearest_from_beta_2(entry), entry.published);
      });
  }

  /// @param cell  the text of one entry
  template<class Cell>
  void line(const std::string& test, const std::string& measure, const std::string& label,
            const Cell& cell) const {
    fmt::print(out_, "  {:<8} {:<18} {:<22}", test, measure, label);
    for (std::size_t c = 0; c < sheet_.columns.size(); ++c) {
      const TableEntry* entry = sheet_.find(row_, c);
      fmt::print(out_, " {:>16}", entry ? cell(*entry) : std::string());
    }
    fmt::print(out_, "\n");
  }

 private:
  std::ostream& out_;
  const Sheet& sheet_;
  std::size_t row_;
};

void write_commands(std::ostream& out, const Sheet& sheet, Commands commands) {
  if (commands == Commands::one_per_table) {
    const TableEntry& first = *sheet.entries.front();
    fmt::print(out, "  {} again: {}\n", name_of(first.published), first.declared().trace.command);
    return;
  }
  for (const TableEntry* entry : sheet.entries)
    for (const ComputedFigure& c : entry->computed)
      fmt::print(out, "  {} ({}): {}\n", name_of(entry->published), c.reference, c.trace.command);
}

void write_sheet(std::ostream& out, const Sheet& sheet, Commands commands) {
  fmt::print(out, "\n{}\n", title(sheet));
  for (std::size_t part = 0; part < 3; ++part) {
    fmt::print(out, "  {:<8} {:<18} {:<22}", "", "", "");
    for (const auto& column : sheet.columns) fmt::print(out, " {:>16}", column[part]);
    fmt::print(out, "\n");
  }
  for (std::size_t row = 0; row < sheet.rows.size(); ++row) MeasureRows(out, sheet, row).write();
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
  write_commands(out, sheet, commands);
}

} // namespace

void write_tables_text(std::ostream& out, const ThesisResults& results, Commands commands) {
  for (const Sheet& sheet : sheets_of(results.entries)) write_sheet(out, sheet, commands);
  if (commands == Commands::one_per_table)
    fmt::print(out,
               "\nThe command behind every other number: --trace, or the column `command` of tables.csv.\n");
  write_designs_text(out, results.designs);
  write_volumes_text(out, results.volumes, results.cell_volume_changes);
  write_advice_text(out, results.advice);
  write_summary_text(out, summarise(results.entries));
}

} // namespace springproof::compare
