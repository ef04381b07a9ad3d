#include "compare/report/html.hpp"
#include "compare/report/sections.hpp"
#include "compare/report/traced.hpp"

#include <fmt/format.h>

namespace springproof::compare::html {

namespace {

/// @param name  as HTML
std::string volume_row(const std::string& name, const char* model, const ModelVolumes& volumes, double rest) {
  std::string html = fmt::format("<tr><td class='text'>{}</td><td class='text'>{}</td>", name, model);
  if (!volumes.total || !volumes.per_cell)
    return html + "<td class='text' colspan='8'>no equilibrium</td></tr>\n";
  const BoxPlot& b = *volumes.per_cell;
  html += fmt::format("<td>{:.2f}</td><td>{:+.2f}</td>", *volumes.total, 100 * (*volumes.total / rest - 1));
  for (const double figure : {b.lower_whisker, b.lower_quartile, b.median, b.upper_quartile, b.upper_whisker})
    html += fmt::format("<td>{:.4f}</td>", figure);
  return html + fmt::format("<td>{}</td></tr>\n", b.outliers.size());
}

} // namespace

std::string designs_section(const ThesisResults& results) {
  if (results.designs.empty()) return "";
  std::string html =
      R"(<p>The same tests with springs of other designs: |error| against the table's declared reference. A
method designs from the table's own material. Click an error for its command.</p>
<div class='scroll'><table data-table='designs'><thead><tr><th class='text'>table</th><th
class='text'>design</th><th>figures</th><th>missing</th><th>mean, %</th><th>worst, %</th><th
class='text'>where</th><th class='text'>why some are missing</th></tr></thead><tbody>
)";
  for (std::size_t r = 0; r < results.designs.size(); ++r) {
    const DesignRow& row = results.designs[r];
    const bool is_first = r == 0 || results.designs[r - 1].table != row.table;
    const Trace whole_table{"", {}, "build/springproof tables " + row.table};
    std::string reasons;
    for (const std::string& reason : row.reasons) reasons += (reasons.empty() ? "" : "<br>") + escape(reason);
    html += fmt::format(R"(<tr{}><td class='text'>{}</td><td
class='text'>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td class='text'>{}</td><td
class='long'>{}</td></tr>
)",
                        is_first ? " class='group'" : "", is_first ? row.table : "", escape(row.design),
                        row.n_figures, row.n_missing, traced(number(row.mean), whole_table),
                        traced(number(row.worst), row.worst_trace), escape(row.worst_at), reasons);
  }
  return html + "</tbody></table></div>\n";
}

std::string volumes_section(const ThesisResults& results) {
  if (results.volumes.empty()) return "";
  std::string html =
      R"(<div class='scroll'><table data-table='volumes'><caption>Deformed volumes, mm³: of the body, and of its cells as a box plot (whiskers at the outermost values within 1.5 times the
interquartile range of the box)</caption>
<thead><tr><th class='text'>case</th><th></th><th>body</th><th>change,
%</th><th>whisker</th><th>quartile</th><th>median</th><th>quartile</th><th>whisker</th><th>outliers</th></tr></thead><tbody>
)";
  for (const CaseVolumes& v : results.volumes)
    html += volume_row(traced(v.name, v.trace), "FEM", v.fem, v.rest) + volume_row("", "MSM", v.msm, v.rest);
  html +=
      "</tbody></table></div>\n<p>The whole table again, box plots and all: <code>build/springproof tables "
      "5.2</code></p>\n";
  for (const CellVolumeChange& change : results.cell_volume_changes)
    html += fmt::format(
        "<p>Figure 5.10, {} loads: the springs' cells between the whiskers change their volume by up to "
        "{} %; the thesis says {:g} %. Again: <code>build/springproof tables 5.2</code></p>\n",
        escape(change.load_set), number(change.computed), change.published);
  return html;
}

} // namespace springproof::compare::html
