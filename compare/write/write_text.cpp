#include "compare/write/write_text.hpp"

#include "cases/case/names.hpp"
#include "compare/provenance/print.hpp"
#include "compare/table/table.hpp"
#include "compare/write/measures_text.hpp"
#include "compare/write/scene_text.hpp"
#include "compare/write/springs_text.hpp"
#include "compare/write/warnings.hpp"
#include "compare/write/write_gates.hpp"
#include "compare/write/write_landmarks.hpp"
#include "compare/write/write_motion.hpp"

#include <algorithm>
#include <utility>

namespace springproof::compare {

namespace {

constexpr std::size_t behind_label = 11; ///< "  springs  "

/// A paragraph about one side, under its label or further down.
void write_labelled(std::ostream& out, const std::string& label, const std::string& text) {
  write_wrapped(out, fmt::format("  {:<9}{}", label, text), behind_label);
}

void write_below(std::ostream& out, const std::string& text) {
  write_wrapped(out, std::string(behind_label, ' ') + text, behind_label);
}

/// How fast a motion was followed.
void write_motion_text(std::ostream& out, const cases::Trajectory& motion, double seconds) {
  const double simulated = motion.time.back() - motion.time.front();
  write_below(out, fmt::format("{} steps to {:.6g} s ({} halved), real time x {:.3g}", motion.time.size() - 1,
                               motion.time.back(), motion.halved_steps, simulated / seconds));
  if (motion.unfinished_steps > 0)
    write_below(
        out, fmt::format(
                 "{} steps ended in real time with more than 1 % of the loads unbalanced, {:.2g} % at most",
                 motion.unfinished_steps, 100 * motion.largest_residual));
}

std::string inverted_text(const cases::Solution& solution) {
  return solution.inverted_cells > 0 ? fmt::format(", {} inverted cells", solution.inverted_cells) : "";
}

/// What it took to solve a side that did not fail.
std::string effort_text(const Answer& side) {
  const cases::Solution& s = side.solution;
  const bool is_relaxed = s.relaxation_iterations > 0;
  const long n_iterations = is_relaxed ? s.relaxation_iterations : s.newton_iterations;
  std::string text = fmt::format("{}, {} unknowns, {} {} iteration{}, {:.3g} s",
                                 s.is_equilibrium() ? cases::name_of(s.status) : "not in equilibrium",
                                 s.unknowns, n_iterations, is_relaxed ? "explicit" : "Newton",
                                 n_iterations == 1 ? "" : "s", side.seconds());
  if (!s.is_equilibrium()) text += fmt::format(", residual {:.1e}", s.residual);
  text += inverted_text(s);
  if (s.negative_eigenvalues.value_or(0) > 0)
    text += fmt::format(", unstable: {} negative eigenvalues of the tangent", *s.negative_eigenvalues);
  if (s.lowest_eigenvalue)
    text += fmt::format(", lowest tangent eigenvalue {:.3g} N/mm", *s.lowest_eigenvalue);
  return text;
}

void write_side(std::ostream& out, const std::string& label, const std::string& what, const Answer& side,
                bool is_motion) {
  const cases::Solution& s = side.solution;
  if (s.status == cases::Status::skipped) return;
  if (s.status == cases::Status::failed) {
    write_labelled(out, label,
                   fmt::format("{}: failed at {:.4g} of the {}: {}", what, s.load_reached,
                               is_motion ? "time" : "load", s.message));
    return;
  }
  write_labelled(out, label, what + ": " + effort_text(side));
  if (s.trajectory) write_motion_text(out, *s.trajectory, side.solve_seconds);
  if (!s.message.empty()) write_below(out, s.message);
}

void write_fem(std::ostream& out, const Comparison& comparison) {
  const cases::Case& definition = comparison.scene.definition;
  const Answers& answers = comparison.answers;
  write_side(out, "fem",
             cases::name_of(answers.resolved.formulation) + " " + cases::name_of(definition.fem.element),
             answers.fem, definition.dynamics.has_value());
  for (const std::string& choice : answers.choices) write_below(out, choice);
}

std::string describe(const std::optional<msm::DesignResult>& design, cases::Design method) {
  if (!design) return cases::name_of(method);
  return cases::name_of(method) + " with " + springs_text(*design);
}

/// Estimates of what results on another mesh have lost on the way to this one.
std::string interpolation_text(const std::vector<MeasuredValue>& measures) {
  std::string text = "the interpolation adds up to (fem's displacement, interpolated there and back):";
  const char* separator = "";
  for (const MeasuredValue& m : measures) {
    text += fmt::format("{} {} {} {}", std::exchange(separator, ";"), m.name,
                        m.interpolation_error ? fmt::format("{:.2g}", *m.interpolation_error) : "-", m.unit);
    if (m.interpolation_error_percent) text += fmt::format(" ({:.2g} %)", *m.interpolation_error_percent);
  }
  return text;
}

void write_interpolated(std::ostream& out, const Comparison& comparison) {
  const Interpolated& from = *comparison.answers.interpolated;
  std::string text = fmt::format("interpolated between {} points", from.n_points);
  if (from.n_outside > 0)
    text += fmt::format("; {} nodes outside of their cells, by up to {:.2g} mm, take the closest value",
                        from.n_outside, from.largest_distance);
  write_below(out, text);
  write_below(out, from.fem_and_back.converged()
                       ? interpolation_text(comparison.measures)
                       : "the interpolation's error is not known: fem has no displacement to try it on");
}

/// Another program's displacements in place of our springs'.
void write_external(std::ostream& out, const Comparison& comparison) {
  const Answers& answers = comparison.answers;
  write_labelled(out, "springs",
                 fmt::format("displacements of {} at {} nodes{}", answers.msm_source,
                             comparison.scene.mesh.nodes.size(), inverted_text(answers.msm.solution)));
  if (!answers.msm.solution.message.empty()) write_below(out, answers.msm.solution.message);
}

void write_springs(std::ostream& out, const Comparison& comparison) {
  const cases::Case& definition = comparison.scene.definition;
  const Answers& answers = comparison.answers;
  if (answers.msm_source.empty())
    write_side(out, "springs", describe(answers.design, definition.msm.design), answers.msm,
               definition.dynamics.has_value());
  else
    write_external(out, comparison);
  if (answers.interpolated) write_interpolated(out, comparison);
}

/// One paragraph: what became of the peer, and how far it is from the finite elements.
void write_peer(std::ostream& out, const Peer& peer) {
  const cases::Solution& s = peer.answer.solution;
  std::string text = fmt::format("{}: {}", peer.program, cases::name_of(s.status));
  if (s.status != cases::Status::converged) {
    write_labelled(out, "peer", text + ": " + s.message);
    return;
  }
  text += fmt::format(", {} unknowns, {} iterations, {:.3g} s", s.unknowns, s.newton_iterations,
                      peer.answer.solve_seconds);
  if (peer.largest_difference)
    text += fmt::format(", displacements within {:.1e} of fem's (of the largest)", *peer.largest_difference);
  write_labelled(out, "peer", text);
}

} // namespace

void write_text(std::ostream& out, const Comparison& comparison, MeshTable meshes) {
  const cases::Case& definition = comparison.scene.definition;
  write_wrapped(out, definition.name + ": " + definition.description, 2);
  write_scene_text(out, comparison.scene);
  write_fem(out, comparison);
  write_springs(out, comparison);
  if (comparison.answers.peer) write_peer(out, *comparison.answers.peer);
  for (const std::string& warning : warnings_of(comparison)) write_wrapped(out, "  Warning: " + warning, 4);
  for (const std::string& note : notes_on_motion(comparison)) write_wrapped(out, "  " + note, 4);
  write_measures_text(out, comparison);
  if (comparison.mesh_study && meshes == MeshTable::printed)
    write_mesh_study_text(out, *comparison.mesh_study);
  write_landmarks_text(out, comparison);
  for (const std::string& doubt : comparison.doubts()) write_wrapped(out, "  FAILED: " + doubt, 4);
  write_expectations_text(out, comparison.gates);
}

} // namespace springproof::compare
