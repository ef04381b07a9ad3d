#include "compare/report/html.hpp"
#include "compare/report/sections.hpp"
#include "compare/report/traced.hpp"
#include "compare/thesis/sheet.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace springproof::compare::html {

namespace {

/// One cell of the springs is compared in absolute figures, which need more digits than percents.
int decimals(const PublishedFigure& figure) {
  if (figure.measure.find("multiplicity") != std::string::npos) return 0;
  return figure.test == "cell" ? 4 : 2;
}

std::string anchor(const Sheet& sheet, const TableEntry& entry, std::size_t reference) {
  std::size_t n = 0;
  while (sheet.entries[n] != &entry) ++n;
  return fmt::format("trace-{}-{}-{}", sheet.table, n, reference);
}

std::string computed_cell(const Sheet& sheet, const TableEntry& entry, std::size_t reference) {
  const ComputedFigure& c = entry.computed[reference];
  const bool is_nearest = entry.computed.size() > 1 && entry.nearest() == &c;
  return fmt::format("<td{}><a href='#{}' title='{}'>{}{}</a></td>", is_nearest ? " class='nearest'" : "",
                     anchor(sheet, entry, reference), provenance(c.trace),
                     number(c.value, decimals(entry.published)), is_nearest ? "*" : "");
}

/// The mark is a circle, the emptier the farther from print.
std::string difference_cell(const TableEntry& entry) {
  const ComputedFigure* nearest = entry.nearest();
  if (!nearest) return "<td class='beyond'>no value</td>";
  const double difference = *nearest->value - entry.published.value;
  const std::string size_and_sign = number(difference, decimals(entry.published));
  const std::string text = (size_and_sign.front() == '-' ? "" : "+") + size_and_sign;
  if (entry.published.test == "cell") return "<td>" + text + "</td>";
  const double size = std::abs(difference);
  const char* mark = size <= 0.1 ? "●" : size <= 0.5 ? "◕" : size <= 1 ? "◑" : size <= 2 ? "◔" : "○";
  return fmt::format("<td class='{}'>{} {}</td>",
                     size <= 1   ? "within"
                     : size <= 2 ? ""
                                 : "beyond",
                     mark, text);
}

std::string published_cell(const TableEntry& entry) {
  const std::string value = number(entry.published.value, decimals(entry.published));
  if (entry.finding.empty()) return "<td>" + value + "</td>";
  return fmt::format("<td title='{}'>{} <abbr>!</abbr></td>", escape(entry.finding), value);
}

/// Whether a part of the columns' names tells them apart; one that does not goes into the caption.
bool is_telling(const Sheet& sheet, std::size_t part) {
  return std::any_of(sheet.columns.begin(), sheet.columns.end(),
                     [&](const auto& column) { return column[part] != sheet.columns.front()[part]; });
}

std::string caption(const Sheet& sheet) {
  std::string text = subject_of(sheet);
  for (std::size_t part = 0; part < 3; ++part)
    if (!is_telling(sheet, part) && !sheet.columns.front()[part].empty())
      text += "; " + sheet.columns.front()[part];
  return "<caption>" + escape(text) + "</caption>\n";
}

std::string measure_heading(const Sheet& sheet, std::size_t row, std::size_t n_lines) {
  const auto& [test, measure] = sheet.rows[row];
  return fmt::format("<th class='text' rowspan='{}'>{}</th>", n_lines,
                     escape(test == "cell" ? measure : test + " " + measure));
}

std::string column_headings(const Sheet& sheet) {
  std::string html = "<thead>\n";
  for (std::size_t part = 0; part < 3; ++part) {
    if (!is_telling(sheet, part)) continue;
    html += "<tr><th></th><th></th>";
    for (const auto& column : sheet.columns) html += "<th>" + escape(column[part]) + "</th>";
    html += "</tr>\n";
  }
  return html + "</thead>\n";
}

/// One measure of a table as in print, a column per variant; below each other the references, print,
/// difference.
std::string measure_lines(const Sheet& sheet, std::size_t row) {
  const std::vector<ComputedFigure>& references = sheet.first_of_row(row)->computed;
  std::string html = "<tbody class='measure'>\n";
  std::string heading = measure_heading(sheet, row, references.size() + 2);
  const auto line = [&](const std::string& label, const auto& cell) {
    html += "<tr>" + std::exchange(heading, "") + "<th class='text'>" + escape(label) + "</th>";
    for (std::size_t c = 0; c < sheet.columns.size(); ++c) {
      const TableEntry* entry = sheet.find(row, c);
      html += entry ? cell(*entry) : "<td></td>";
    }
    html += "</tr>\n";
  };
  for (std::size_t k = 0; k < references.size(); ++k)
    line(references[k].reference, [&](const TableEntry& entry) { return computed_cell(sheet, entry, k); });
  line("published", published_cell);
  line("difference", difference_cell);
  return html + "</tbody>\n";
}

/// A table with a single variant: a line per measure.
std::string flat_table(const Sheet& sheet) {
  std::string html = "<thead><tr><th></th>";
  for (const ComputedFigure& c : sheet.entries.front()->computed)
    html += "<th>" + escape(c.reference) + "</th>";
  html += "<th>published</th><th>difference</th></tr></thead>\n<tbody>\n";
  for (std::size_t row = 0; row < sheet.rows.size(); ++row) {
    const TableEntry& entry = *sheet.first_of_row(row);
    html += "<tr>" + measure_heading(sheet, row, 1);
    for (std::size_t k = 0; k < entry.computed.size(); ++k) html += computed_cell(sheet, entry, k);
    html += published_cell(entry) + difference_cell(entry) + "</tr>\n";
  }
  return html + "</tbody>\n";
}

std::string table(const Sheet& sheet) {
  if (sheet.columns.size() == 1) return flat_table(sheet);
  std::string html = column_headings(sheet);
  for (std::size_t row = 0; row < sheet.rows.size(); ++row) html += measure_lines(sheet, row);
  return html;
}

/// A line for each number: both models' measures and the command.
std::string trace_table(const Sheet& sheet) {
  std::string html =
      R"(<details><summary>Case file, settings and command of each number</summary>
<div class='scroll'><table><thead><tr><th class='text'>figure</th><th
class='text'>reference</th><th>value</th><th>FEM</th><th>MSM</th><th class='text'>command (in
the source folder)</th></tr></thead><tbody>
)";
  for (const TableEntry* entry : sheet.entries)
    for (std::size_t k = 0; k < entry->computed.size(); ++k) {
      const PublishedFigure& p = entry->published;
      const ComputedFigure& c = entry->computed[k];
      html += fmt::format(
          R"(<tr id='{}'><td class='text'>{}</td><td class='text'>{}</td><td>{}</td><td>{}</td><td>{}</td><td
class='long'><code>{}</code>{}{}</td></tr>
)",
          anchor(sheet, *entry, k), escape(name_of(p)), escape(c.reference), number(c.value, decimals(p)),
          number(c.fem, 4), number(c.msm, 4), escape(c.trace.command),
          c.reason.empty() ? "" : "<br>no value: " + escape(c.reason),
          k + 1 < entry->computed.size() || entry->finding.empty() ? "" : "<br>" + escape(entry->finding));
    }
  return html + "</tbody></table></div></details>\n";
}

} // namespace

std::string tables_section(const ThesisResults& results) {
  std::string html =
      R"(<p>Each number of ours is a link to the line below its table that has its case file, settings
and command; resting the pointer on it shows them too. Where two finite-element references were
computed, the declared one stands first and * marks the one nearer to print, from which the
difference is taken. Differences, in points of percent or mm³: ● within 0.1, ◕ 0.5, ◑ 1, ◔ 2, ○
more. An exclamation mark after a printed figure: something is known about it (rest the pointer
on it).</p>
)";
  for (const Sheet& sheet : sheets_of(results.entries)) {
    html += fmt::format("<h3 id='table-{0}'>{1}</h3>\n<div class='scroll'><table data-table='{0}'>\n",
                        sheet.table, name_of(sheet));
    html += caption(sheet) + table(sheet) + "</table></div>\n" + trace_table(sheet);
  }
  return html;
}

} // namespace springproof::compare::html
