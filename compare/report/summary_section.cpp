#include "compare/report/html.hpp"
#include "compare/report/sections.hpp"
#include "compare/report/traced.hpp"
#include "compare/thesis/sheet.hpp"

#include <fmt/format.h>

namespace springproof::compare::html {

namespace {

std::string counts(const SummaryGroup& group) {
  std::string html =
      fmt::format("<tbody class='measure'>\n<tr><th class='text' rowspan='{}'>{}</th>", group.within.size(),
                  traced(fmt::format("{}, {} figures", group.name, group.n_entries), group.trace));
  for (const Within& w : group.within)
    html += fmt::format("{}<td>{:g} {}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                        &w == &group.within.front() ? "" : "<tr>", w.bound, escape(group.unit), w.declared,
                        w.other_only, w.neither);
  return html + "</tbody>\n";
}

std::string beyond(const TableEntry& entry) {
  const PublishedFigure& p = entry.published;
  std::string computed;
  for (const ComputedFigure& c : entry.computed)
    computed += fmt::format("{}{}: {}", computed.empty() ? "" : "<br>", escape(c.reference),
                            c.value ? traced(number(c.value, p.test == "cell" ? 4 : 2), c.trace)
                                    : "no value, " + escape(c.reason));
  return fmt::format(
      R"(<tr><td class='text'><a href='#table-{0}'>{0}</a></td><td class='text'>{1}</td><td>{2:g}</td>
<td>{3}</td><td class='long'>{4}</td></tr>
)",
      p.table, escape(name_of(p)), p.value, computed,
      entry.finding.empty() ? "unexplained" : escape(entry.finding));
}

} // namespace

std::string summary_section(const ThesisResults& results) {
  const std::vector<SummaryGroup> groups = summarise(results.entries);
  if (groups.empty()) return "";
  std::string html =
      R"(<div class='scroll'><table data-table='summary'><caption>Printed figures that are reproduced; a click on a group shows the
command that counts it again</caption>
<thead><tr><th></th><th>within</th><th>by the declared reference</th><th>only by the other</th>
<th>by neither</th></tr></thead>
)";
  for (const SummaryGroup& group : groups) html += counts(group);
  html += "</table></div>\n";
  for (const SummaryGroup& group : groups) {
    if (group.beyond.empty()) continue;
    html += fmt::format(R"(<details><summary>{}: {} not within {:g} {} of any reference</summary>
<div class='scroll'><table><thead><tr><th class='text'>table</th><th class='text'>figure</th><th>published</th>
<th>computed</th><th class='text'>explanation</th></tr></thead><tbody>
)",
                        escape(group.name), group.beyond.size(), group.listing_bound, escape(group.unit));
    for (const TableEntry* entry : group.beyond) html += beyond(*entry);
    html += "</tbody></table></div></details>\n";
  }
  return html;
}

} // namespace springproof::compare::html
