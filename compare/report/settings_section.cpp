#include "cases/case/names.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/version.hpp"
#include "compare/report/html.hpp"
#include "compare/report/sections.hpp"
#include "compare/report/traced.hpp"

#include <fmt/format.h>

namespace springproof::compare::html {

namespace {

std::string fact(const std::string& name, const std::string& value) {
  return "<tr><th class='text'>" + escape(name) + "</th><td class='long'>" + escape(value) + "</td></tr>\n";
}

std::string outcome(const Answer& side) {
  const cases::Solution& s = side.solution;
  if (s.status != cases::Status::converged)
    return fmt::format("<td class='long' colspan='3'>{}</td>", escape(s.message));
  return fmt::format("<td>{}</td><td>{:.1e}</td><td>{:.2f}</td>", s.unknowns, s.residual,
                     side.setup_seconds + side.solve_seconds);
}

std::string case_row(const Comparison& comparison, const Trace& trace) {
  const cases::Fem& fem = comparison.answers.resolved;
  std::string stiffness = "–";
  if (comparison.answers.design) {
    const msm::CellStiffness& k = comparison.answers.design->stiffness;
    stiffness =
        fmt::format("{:.4g}, {:.4g}, {:.4g}", 1e3 * k.edge, 1e3 * k.face_diagonal, 1e3 * k.internal_diagonal);
  }
  return fmt::format("<tr><td class='text'>{}</td><td class='text'>{} {}</td>{}<td>{}</td>{}</tr>\n",
                     traced(trace.case_file, trace), cases::name_of(fem.formulation),
                     cases::name_of(fem.element), outcome(comparison.answers.fem), stiffness,
                     outcome(comparison.answers.msm));
}

} // namespace

std::string settings_section(const ThesisResults& results) {
  const Machine machine = describe_machine();
  std::string html =
      "<div class='scroll'><table data-table='machine'><tbody>\n" +
      fact("program", fmt::format("springproof {}, commit {}", program_version(), program_commit())) +
      fact("machine", fmt::format("{}, {} cores; {}", machine.processor, machine.cores, machine.system)) +
      fact("compiler, BLAS", machine.compiler + "; " + machine.blas) +
      fact("workers", fmt::format("{}", results.n_workers));
  for (const PhaseTime& time : results.times)
    html += fact("time: " + time.phase, fmt::format("{:.2f} s", time.seconds));
  html += "</tbody></table></div>\n";
  if (results.cases.empty()) return html;
  html += R"(<div class='scroll'><table data-table='cases'><caption>The cases as drawn below: finite-element
formulation and element, spring stiffnesses k<sub>e</sub>, k<sub>f</sub>, k<sub>d</sub> (N/m),
unknowns, relative residual, seconds</caption>
<thead><tr><th class='text'>case file</th><th
class='text'>FEM</th><th>unknowns</th><th>residual</th><th>s</th><th>MSM</th><th>unknowns</th><th>residual</th><th>s</th></tr></thead><tbody>
)";
  for (std::size_t c = 0; c < results.cases.size(); ++c)
    html += case_row(results.cases[c], results.case_traces[c]);
  return html + "</tbody></table></div>\n";
}

} // namespace springproof::compare::html
