#include "compare/report/html.hpp"
#include "compare/report/sections.hpp"
#include "compare/thesis/sheet.hpp"

#include <cmath>
#include <fmt/format.h>

namespace compare::html {

namespace {

/// One cell of the springs is compared in absolute figures, which need more digits than percents.
int decimals(const PublishedFigure& figure) {
  return figure.test == "cell" ? 4 : 2;
}

std::string anchor(const Sheet& sheet, const TableEntry& entry, std::size_t reference) {
  std::size_t n = 0;
  while (sheet.entries[n] != &entry) ++n;
  return fmt::format("trace-{}-{}-{}", sheet.table, n, reference);
}

/// What a pointer that rests on the number is shown.
std::string provenance(const ComputedFigure& c) {
  std::string text;
  if (!c.trace.case_file.empty()) text += "case: " + c.trace.case_file + "\n";
  for (const std::string& setting : c.trace.settings) text += "setting: " + setting + "\n";
  return escape(text + "command: " + c.trace.command);
}

std::string computed_cell(const Sheet& sheet, const TableEntry& entry, std::size_t reference) {
  const ComputedFigure& c = entry.computed[reference];
  const bool is_nearest = entry.computed.size() > 1 && entry.nearest() == &c;
  return fmt::format("<td{}><a href=\"#{}\" title=\"{}\">{}{}</a></td>",
                     is_nearest ? " class=\"nearest\"" : "", anchor(sheet, entry, reference), provenance(c),
                     number(c.value, decimals(entry.published)), is_nearest ? "*" : "");
}

/// The mark is a circle, the emptier the farther from print.
std::string difference_cell(const TableEntry& entry) {
  const ComputedFigure* nearest = entry.nearest();
  if (!nearest) return "<td class=\"beyond\">no value</td>";
  const double difference = *nearest->value - entry.published.value;
  const std::string text = fmt::format("{:+.{}f}", difference, decimals(entry.published));
  if (entry.published.test == "cell") return "<td>" + text + "</td>";
  const double size = std::abs(difference);
  const char* mark = size <= 0.1 ? "●" : size <= 0.5 ? "◕" : size <= 1 ? "◑" : size <= 2 ? "◔" : "○";
  return fmt::format("<td class=\"{}\">{} {}</td>",
                     size <= 1   ? "within"
                     : size <= 2 ? ""
                                 : "beyond",
                     mark, text);
}

/// A table row of one measure. @param cell  the cell of one entry
template<class Cell>
std::string line(const Sheet& sheet, std::size_t row, const std::string& heading,
                 const std::string& row_class, const Cell& cell) {
  std::string html = row_class.empty() ? "<tr>" : "<tr class=\"" + row_class + "\">";
  html += heading;
  for (std::size_t c = 0; c < sheet.columns.size(); ++c) {
    const TableEntry* entry = sheet.find(row, c);
    html += entry ? cell(*entry) : "<td></td>";
  }
  return html + "</tr>\n";
}

std::string measure_rows(const Sheet& sheet, std::size_t row) {
  const auto& [test, measure] = sheet.rows[row];
  const std::vector<ComputedFigure>& references = sheet.first_of_row(row)->computed;
  std::string heading = fmt::format("<th class=\"text\" rowspan=\"{}\">{} {}</th>", references.size() + 2,
                                    escape(test), escape(measure));
  const auto labelled = [&](const std::string& label) {
    return std::exchange(heading, "") + "<th class=\"text\">" + escape(label) + "</th>";
  };
  std::string html = "<tbody class=\"measure\">\n";
  for (std::size_t k = 0; k < references.size(); ++k)
    html += line(sheet, row, labelled(references[k].reference), "",
                 [&](const TableEntry& entry) { return computed_cell(sheet, entry, k); });
  html += line(sheet, row, labelled("published"), "published", [](const TableEntry& entry) {
    const std::string value = number(entry.published.value, decimals(entry.published));
    return entry.finding.empty()
               ? "<td>" + value + "</td>"
               : fmt::format("<td title=\"{}\">{} <abbr>!</abbr></td>", escape(entry.finding), value);
  });
  html += line(sheet, row, labelled("difference"), "", difference_cell);
  return html + "</tbody>\n";
}

std::string head(const Sheet& sheet) {
  std::string html = "<thead>\n";
  for (std::size_t part = 0; part < 3; ++part) {
    html += "<tr><th></th><th></th>";
    for (const auto& column : sheet.columns) html += "<th>" + escape(column[part]) + "</th>";
    html += "</tr>\n";
  }
  return html + "</thead>\n";
}

/// A line for each number: both models' measures and the command.
std::string trace_table(const Sheet& sheet) {
  std::string html =
      "<details><summary>Case file, settings and command of each number</summary>\n<div "
      "class=\"scroll\"><table><thead><tr><th class=\"text\">figure</th><th class=\"text\">reference</th><th>"
      "value</th><th>FEM</th><th>MSM</th><th class=\"text\">command (in the source folder)</th></tr></thead>"
      "<tbody>\n";
  for (const TableEntry* entry : sheet.entries)
    for (std::size_t k = 0; k < entry->computed.size(); ++k) {
      const PublishedFigure& p = entry->published;
      const ComputedFigure& c = entry->computed[k];
      html += fmt::format(
          "<tr id=\"{}\"><td class=\"text\">{}</td><td "
          "class=\"text\">{}</td><td>{}</td><td>{}</td><td>{}</td><td "
          "class=\"long\"><code>{}</code>{}{}</td></tr>\n",
          anchor(sheet, *entry, k), escape(name_of(p)), escape(c.reference), number(c.value, decimals(p)),
          number(c.fem, 4), number(c.msm, 4), escape(c.trace.command),
          c.reason.empty() ? "" : "<br>no value: " + escape(c.reason),
          k + 1 < entry->computed.size() || entry->finding.empty() ? "" : "<br>" + escape(entry->finding));
    }
  return html + "</tbody></table></div></details>\n";
}

} // namespace

std::string tables_section(const ThesisResults& results) {
  std::string html = "<p>Each number of ours is a link to the line below its table that has its case file, "
                     "settings and command; resting the "
                     "pointer on it shows them too. Where two finite-element references were computed, the "
                     "declared one stands first and * marks "
                     "the one nearer to print, from which the difference is taken. Differences, in points of "
                     "percent or mm³: ● within 0.1, ◕ 0.5, "
                     "◑ 1, ◔ 2, ○ more. An exclamation mark after a printed figure: something is known about "
                     "it (rest the pointer on it).</p>\n";
  for (const Sheet& sheet : sheets_of(results.entries)) {
    html += fmt::format(
        "<h3 id=\"table-{0}\">{1}</h3>\n<div class=\"scroll\"><table class=\"thesis\" data-table=\"{0}\">"
        "<caption>{2}</caption>\n{3}",
        sheet.table, name_of(sheet), escape(subject_of(sheet)), head(sheet));
    for (std::size_t row = 0; row < sheet.rows.size(); ++row) html += measure_rows(sheet, row);
    html += "</table></div>\n" + trace_table(sheet);
  }
  return html;
}

} // namespace compare::html
