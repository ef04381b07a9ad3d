#include "compare/write/write.hpp"

#include "cases/case/names.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

namespace springproof::compare {

namespace {

std::string number(const std::optional<double>& value, const char* format) {
  return value ? fmt::format(fmt::runtime(format), *value) : "-";
}

void write_side(std::ostream& out, const char* label, const std::string& what, const Answer& side) {
  const cases::Solution& s = side.solution;
  if (s.status == cases::Status::skipped) return;
  fmt::print(out, "  {}  {}: {}", label, what, cases::name_of(s.status));
  if (s.status == cases::Status::failed) {
    fmt::print(out, " at {:.4g} of the load: {}\n", s.load_reached, s.message);
    return;
  }
  const bool is_relaxed = s.relaxation_iterations > 0;
  fmt::print(out, ", {} unknowns, {} {} iterations, residual {:.1e}, setup {:.3f} s, solve {:.3f} s",
             s.unknowns, is_relaxed ? s.relaxation_iterations : s.newton_iterations,
             is_relaxed ? "explicit" : "Newton", s.residual, side.setup_seconds, side.solve_seconds);
  if (s.inverted_cells > 0) fmt::print(out, ", {} INVERTED CELLS", s.inverted_cells);
  if (s.negative_eigenvalues.value_or(0) > 0)
    fmt::print(out, ", UNSTABLE: {} negative eigenvalues of the tangent", *s.negative_eigenvalues);
  if (s.lowest_eigenvalue) fmt::print(out, ", lowest tangent eigenvalue {:.3g} N/mm", *s.lowest_eigenvalue);
  fmt::print(out, "\n");
}

void write_external(std::ostream& out, const Comparison& comparison) {
  const cases::Solution& s = comparison.answers.msm.solution;
  fmt::print(out, "  msm  displacements of {} at {} nodes", comparison.answers.msm_source,
             s.displacement.size());
  if (s.inverted_cells > 0) fmt::print(out, ", {} INVERTED CELLS", s.inverted_cells);
  fmt::print(out, "\n");
}

std::string describe(const msm::DesignResult& design, cases::Design method) {
  const msm::CellStiffness& k = design.stiffness;
  std::string text = fmt::format("{} k_e, k_f, k_d = {:.4g}, {:.4g}, {:.4g} N/m", cases::name_of(method),
                                 1e3 * k.edge, 1e3 * k.face_diagonal, 1e3 * k.internal_diagonal);
  if (k.volume != 0) text += fmt::format(", k_v = {:.4g} MPa", k.volume);
  return text;
}

} // namespace

void write_text(std::ostream& out, const Comparison& comparison) {
  const cases::Case& definition = comparison.scene.definition;
  fmt::print(out, "{}: {}\n", definition.name, definition.description);
  write_side(out, "fem",
             cases::name_of(comparison.answers.resolved.formulation) + " " +
                 cases::name_of(definition.fem.element),
             comparison.answers.fem);
  for (const std::string& choice : comparison.answers.choices) fmt::print(out, "       {}\n", choice);
  const std::string design = comparison.answers.design
                                 ? describe(*comparison.answers.design, definition.msm.design)
                                 : cases::name_of(definition.msm.design);
  if (comparison.answers.msm_source.empty())
    write_side(out, "msm", design, comparison.answers.msm);
  else
    write_external(out, comparison);
  if (comparison.answers.design)
    for (const std::string& warning : comparison.answers.design->warnings)
      fmt::print(out, "  warning: {}\n", warning);
  if (comparison.answers.peer) write_text(out, *comparison.answers.peer);
  const std::string peer =
      comparison.answers.peer ? fmt::format(" {:>14}", comparison.answers.peer->program) : "";
  fmt::print(out, "  {:<24} {:>4} {:>14} {:>14} {:>10}{}\n", "measure", "unit", "fem", "msm", "error %",
             peer);
  for (const MeasuredValue& m : comparison.measures)
    fmt::print(out, "  {:<24} {:>4} {:>14} {:>14} {:>10}{}\n", m.name, m.unit, number(m.fem, "{:.6g}"),
               number(m.msm, "{:.6g}"), number(m.error_percent, "{:+.2f}"),
               comparison.answers.peer ? fmt::format(" {:>14}", number(m.peer, "{:.6g}")) : "");
  if (comparison.mesh_study) write_text(out, *comparison.mesh_study);
  for (const Gate& gate : comparison.gates)
    fmt::print(out, "  {} {} ({}): {}\n", gate.met() ? "met   " : "MISSED",
               gate.judgement.expectation.measure, cases::name_of(gate.judgement.expectation.reference),
               gate.met() ? fmt::format("{:.6g}", *gate.judgement.value) : gate.judgement.reason);
}

} // namespace springproof::compare
