#include "compare/report/html.hpp"
#include "compare/report/sections.hpp"
#include "compare/report/traced.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace springproof::compare::html {

namespace {

/// Worst, mean, and what became of the tests.
std::string errors(const Advice& a, const Advice::Errors& e) {
  if (!e.worst)
    return fmt::format("<td>–</td><td>–</td><td class='text'>{}</td>",
                       a.stiffness ? "a test failed" : "refused");
  return fmt::format("<td>{}</td><td>{}</td><td class='text'>{}</td>", traced(number(e.worst, 1), e.trace),
                     number(e.mean, 1), e.is_stable ? "stable" : "unstable");
}

std::string stiffness(const std::optional<msm::CellStiffness>& k) {
  if (!k) return "<td>–</td><td>–</td><td>–</td><td>–</td>";
  return fmt::format("<td>{:.4f}</td><td>{:.4f}</td><td>{:.4f}</td><td>{:.4f}</td>", k->edge,
                     k->face_diagonal, k->internal_diagonal, k->volume);
}

/// @param previous  the line above; null for the first
std::string row(const Advice& a, const Advice* previous) {
  const bool is_first = !previous || previous->poissons_ratio != a.poissons_ratio;
  return fmt::format("<tr class='{}{}'><td>{}</td><td class='text'>{}{}</td>{}{}{}</tr>\n",
                     is_first ? "group " : "", a.is_recommended ? "recommended" : "",
                     is_first ? fmt::format("{:g}", a.poissons_ratio) : "",
                     traced(a.design + (a.is_recommended ? " ← use" : ""), a.trace),
                     a.refusal.empty() ? "" : "<span class='reason'>" + escape(a.refusal) + "</span>",
                     stiffness(a.stiffness), errors(a, a.small), errors(a, a.large));
}

/// A sentence that can be used as it stands, for E = 50 kPa; the page's script rewrites it for other
/// materials.
std::string recommendation(const Advice& a) {
  constexpr double youngs_modulus = 0.05; // MPa: soft tissue
  const msm::CellStiffness& k = *a.stiffness;
  const double springs = 1e3 * youngs_modulus; // N/m per unit, edge 1 mm
  const auto worst_volume = std::max(a.small.worst_volume.value_or(0), a.large.worst_volume.value_or(0));
  return fmt::format(R"(<li data-nu='{0:g}' data-design='{1}' data-edge='{2:.6g}' data-face='{3:.6g}'
data-internal='{4:.6g}' data-volume='{5:.6g}'>ν = {0:g}: <b>{1}</b>; for E = 50 kPa and cells of
1 mm k<sub>e</sub> = {6:.2f}, k<sub>f</sub> = {7:.2f}, k<sub>d</sub> = {8:.2f} N/m and
k<sub>v</sub> = {9:.5f} MPa. <span class='expected'>Expected errors: up to {10} % under the
small loads, {11} % under the large ones, {12} % in volume.</span></li>
)",
                     a.poissons_ratio, escape(a.design), k.edge, k.face_diagonal, k.internal_diagonal,
                     k.volume, springs * k.edge, springs * k.face_diagonal, springs * k.internal_diagonal,
                     youngs_modulus * k.volume, number(a.small.worst, 1), number(a.large.worst, 1),
                     number(worst_volume, 2));
}

} // namespace

std::string advice_section(const ThesisResults& results) {
  if (results.advice.empty()) return "";
  std::string html =
      R"(<p>For a linear elastic material the best stiffnesses grow with E and with the cell's edge
L<sub>0</sub>, and depend on Poisson's ratio alone otherwise. So one line serves every material
of that ratio: a spring's stiffness is the figure times E L<sub>0</sub>, the volume term's the
figure times E. Recommended is the smallest worst error over both load sets among the designs
that stay stable in every test. The errors are those of the thesis's cube, at equal strains
(loads in proportion to E).</p>
<form id='calculator' hidden>E <input name='young' type='number' min='0' step='any' value='50'
size='7'> kPa, ν <select name='nu'></select>, cells of <input name='edge' type='number' min='0'
step='any' value='1' size='5'> mm: <output></output></form>
<ul id='recommended'>
)";
  for (const Advice& a : results.advice)
    if (a.is_recommended && a.stiffness) html += recommendation(a);
  html += R"(</ul>
<div class='scroll'><table data-table='advice'><caption>Every design on the cube: |error|
against the declared reference, %; a click on a design or a worst error shows its command</caption>
<thead><tr><th rowspan='2'>ν</th><th class='text' rowspan='2'>design</th><th colspan='3'>k/(E
L<sub>0</sub>): edge, face, internal</th><th>k<sub>v</sub>/E</th><th colspan='3'>small
loads</th><th colspan='3'>large loads</th></tr>
<tr><th>k<sub>e</sub></th><th>k<sub>f</sub></th><th>k<sub>d</sub></th><th>k<sub>v</sub></th><th>worst</th><th>mean</th><th></th><th>worst</th><th>mean</th><th></th></tr></thead>
<tbody>
)";
  const Advice* previous = nullptr;
  for (const Advice& a : results.advice) {
    html += row(a, previous);
    previous = &a;
  }
  return html +
         "</tbody></table></div>\n<p>The means again, and everything else here, under <code>advice</code> "
         "of <code>build/springproof tables --json</code>.</p>\n";
}

} // namespace springproof::compare::html
