#include "compare/write/write_text.hpp"

#include "cases/case/names.hpp"
#include "cases/scene/histories.hpp"
#include "cases/scene/loads.hpp"
#include "cases/scene/masses.hpp"
#include "cases/scene/regions.hpp"
#include "compare/provenance/print.hpp"
#include "compare/write/springs_text.hpp"
#include "compare/write/write_gates.hpp"
#include "compare/write/write_landmarks.hpp"
#include "compare/write/write_motion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace springproof::compare {

namespace {

std::string number(const std::optional<double>& value, const char* format) {
  return value ? fmt::format(fmt::runtime(format), *value) : "-";
}

/// How fast a motion was followed.
void write_motion_text(std::ostream& out, const cases::Trajectory& motion, double seconds) {
  const double simulated = motion.time.back() - motion.time.front();
  print(out, "       {} steps to {:.6g} s ({} halved), real time x {:.3g}\n", motion.time.size() - 1,
        motion.time.back(), motion.halved_steps, simulated / seconds);
  if (motion.unfinished_steps > 0)
    print(out,
          "       {} steps ended in real time with more than 1 % of the loads unbalanced, {:.2g} % at most\n",
          motion.unfinished_steps, 100 * motion.largest_residual);
}

void write_side(std::ostream& out, const char* label, const std::string& what, const Answer& side,
                bool is_motion) {
  const cases::Solution& s = side.solution;
  if (s.status == cases::Status::skipped) return;
  print(out, "  {}  {}: {}", label, what,
        s.is_equilibrium() ? cases::name_of(s.status) : "not in equilibrium");
  if (s.status == cases::Status::failed) {
    print(out, " at {:.4g} of the {}: {}\n", s.load_reached, is_motion ? "time" : "load", s.message);
    return;
  }
  const bool is_relaxed = s.relaxation_iterations > 0;
  print(out, ", {} unknowns, {} {} iterations, residual {:.1e}, setup {:.3f} s, solve {:.3f} s", s.unknowns,
        is_relaxed ? s.relaxation_iterations : s.newton_iterations, is_relaxed ? "explicit" : "Newton",
        s.residual, side.setup_seconds, side.solve_seconds);
  if (s.inverted_cells > 0) print(out, ", {} INVERTED CELLS", s.inverted_cells);
  if (s.negative_eigenvalues.value_or(0) > 0)
    print(out, ", UNSTABLE: {} negative eigenvalues of the tangent", *s.negative_eigenvalues);
  if (s.lowest_eigenvalue) print(out, ", lowest tangent eigenvalue {:.3g} N/mm", *s.lowest_eigenvalue);
  print(out, "\n");
  if (s.trajectory) write_motion_text(out, *s.trajectory, side.solve_seconds);
  if (!s.message.empty()) print(out, "       {}\n", s.message);
}

std::string describe(const std::optional<msm::DesignResult>& design, cases::Design method) {
  if (!design) return cases::name_of(method);
  return cases::name_of(method) + " " + springs_text(*design);
}

/// One line: what became of the peer, and how far it is from the finite elements.
void write_peer(std::ostream& out, const Peer& peer) {
  const cases::Solution& s = peer.answer.solution;
  print(out, "  peer {}: {}", peer.program, cases::name_of(s.status));
  if (s.status != cases::Status::converged) {
    print(out, ": {}\n", s.message);
    return;
  }
  print(out, ", {} unknowns, {} iterations, {:.3f} s", s.unknowns, s.newton_iterations,
        peer.answer.solve_seconds);
  if (peer.largest_difference)
    print(out, ", displacements within {:.1e} of fem's (of the largest)", *peer.largest_difference);
  print(out, "\n");
}

/// Where results on another mesh were taken, and what that has cost.
void write_interpolated(std::ostream& out, const Comparison& comparison) {
  const Interpolated& from = *comparison.answers.interpolated;
  print(out, "       interpolated between {} points{}\n", from.n_points,
        from.n_outside == 0
            ? std::string()
            : fmt::format("; {} nodes outside of their cells, by up to {:.2g} mm, take the closest value",
                          from.n_outside, from.largest_distance));
  if (!from.fem_and_back.converged()) {
    print(out, "       the interpolation's error is not known: fem has no displacement to try it on\n");
    return;
  }
  print(out, "       the interpolation adds up to (fem's displacement, interpolated there and back):");
  const char* comma = "";
  for (const MeasuredValue& m : comparison.measures)
    print(out, "{} {} {} {} {}", std::exchange(comma, ";"), m.name, number(m.interpolation_error, "{:.2g}"),
          m.unit,
          m.interpolation_error_percent ? fmt::format("({:.2g} %)", *m.interpolation_error_percent) : "");
  print(out, "\n");
}

/// "9.23 +- 1.1", or without the error bar; "-" when there is no value.
std::string with_bar(const std::optional<double>& value, const char* format,
                     const std::optional<double>& bar) {
  return number(value, format) + (bar ? fmt::format(" +- {:.2g}", *bar) : "");
}

/// The body's size: one in metres is told from one in millimetres.
void write_body(std::ostream& out, const cases::HexMesh& mesh) {
  const Eigen::AlignedBox3d box = cases::bounding_box(mesh);
  double volume = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    volume += cases::cell_volume(cases::cell_vertices(mesh, c));
  print(out, "  body {:.6g} x {:.6g} x {:.6g} mm, {:.6g} mm3, {} cells, {} nodes\n", box.sizes().x(),
        box.sizes().y(), box.sizes().z(), volume, mesh.cells.size(), mesh.nodes.size());
}

/// The applied loads as one force and one moment, unless a load follows a history, and the areas that loads
/// and motions act on: a patch has those of its faces, not of its circle.
void write_loads(std::ostream& out, const cases::Scene& scene) {
  std::vector<std::string> all;
  const auto components = [](Eigen::Vector3d v, double scale) {
    for (double& component : v)
      if (std::abs(component) < 1e-12 * scale) component = 0; // what rounding leaves
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x(), v.y(), v.z());
  };
  if (!scene.loads.empty() && !cases::has_load_histories(scene)) {
    const Eigen::Vector3d centre = cases::bounding_box(scene.mesh).center();
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = force;
    double size = 0, turning = 0;
    for (const auto& [node, of_node] : cases::applied_forces(scene)) {
      const Eigen::Vector3d arm = scene.mesh.nodes[cases::index(node)] - centre;
      force += of_node;
      moment += arm.cross(of_node);
      size += of_node.norm();
      turning += arm.norm() * of_node.norm();
    }
    all.push_back(fmt::format("applied force {} N", components(force, size)));
    all.push_back(
        fmt::format("moment about ({}) {} N mm", fmt::join(centre, ", "), components(moment, turning)));
  }
  const auto add_areas = [&](const char* list, const auto& conditions) {
    for (std::size_t i = 0; i < conditions.size(); ++i)
      if (const double area = cases::area(scene.mesh, conditions[i].selection); area > 0)
        all.push_back(fmt::format("{}[{}] on {:.6g} mm2", list, i, area));
  };
  add_areas("load", scene.loads);
  add_areas("moved", scene.moved);
  if (!all.empty()) print(out, "  {}\n", fmt::join(all, "; "));
}

/// An error; of a measure whose reference is zero there is none.
std::string error_text(const MeasuredValue& measure, const std::optional<double>& reference,
                       const std::optional<double>& error, const std::optional<double>& bar = {}) {
  return !error && reference && measure.msm ? "no percentage" : with_bar(error, "{:+.2f}", bar);
}

/// What a value of all measures has in common, if it has: then it is told once.
template<class Get>
std::string common_text(const std::vector<StudiedMeasure>& measures, const Get& get) {
  const bool is_common =
      !measures.empty() && std::all_of(measures.begin(), measures.end(), [&](const StudiedMeasure& m) {
        return get(m) == get(measures.front());
      });
  return is_common ? get(measures.front()) : "";
}

/// Why the errors are against the same mesh, of those measures of which they are.
void write_missing_limits(std::ostream& out, const MeshStudy& study) {
  const auto reason = [](const StudiedMeasure& m) { return m.no_reference; };
  if (const std::string common = common_text(study.measures, reason); !common.empty()) {
    print(out, "  errors are against the finite elements on the same mesh: {}\n", common);
    return;
  }
  for (const StudiedMeasure& m : study.measures)
    if (!m.reference) print(out, "  {}: error against the same mesh: {}\n", m.name, m.no_reference);
}

/// A table of the values on every mesh, with orders and error bars.
void write_mesh_study(std::ostream& out, const MeshStudy& study) {
  print(out, "  fem on refined meshes    ");
  for (const int refine : study.refine) print(out, " {:>12}", fmt::format("refine {}", refine));
  print(out, " {:>7} {:>12} {:>10} {:>10}\n", "order", "limit", "GCI %", "fem +- %");
  for (const StudiedMeasure& measure : study.measures) {
    print(out, "  {:<24}", measure.name);
    for (const double value : measure.values) print(out, " {:>12.6g}", value);
    if (measure.limit)
      print(out, " {:>7.2f} {:>12.6g} {:>10.2g} {:>10.2g}\n", measure.limit->order,
            measure.limit->extrapolated, measure.limit->index_percent, *measure.discretisation_error_percent);
    else
      print(out, "  no order: {}\n", measure.reason);
  }
}

/// One line a measure: against the limit first, where there is one, then against the same mesh. Then why
/// values are missing.
void write_measures(std::ostream& out, const std::vector<MeasuredValue>& measures,
                    const std::optional<Peer>& peer) {
  const bool has_limits = std::any_of(measures.begin(), measures.end(),
                                      [](const MeasuredValue& m) { return m.fem_limit.has_value(); });
  const auto line = [&](const std::string& name, const std::string& unit, const std::string& fem,
                        const std::string& msm, const std::string& limit, const std::string& error,
                        const std::string& same_mesh, const std::string& fem_error,
                        const std::string& other) {
    print(out, "  {:<24} {:>4} {:>14} {:>14}", name, unit, fem, msm);
    if (has_limits)
      print(out, " {:>22} {:>15} {:>11} {:>11}", limit, error, same_mesh, fem_error);
    else
      print(out, " {:>10}", error);
    if (peer) print(out, " {:>14}", other);
    print(out, "\n");
  };
  line("measure", "unit", "fem", "msm", "fem's limit", "error %", "same mesh %", "fem error %",
       peer ? peer->program : "");
  for (const MeasuredValue& m : measures) {
    const auto& limit = m.fem_limit;
    line(m.name, m.unit, number(m.fem, "{:.6g}"), number(m.msm, "{:.6g}"),
         limit ? with_bar(limit->value, "{:.6g}", limit->uncertainty) : "-",
         error_text(m, limit ? std::optional(limit->value) : m.fem, m.error_percent,
                    m.error_uncertainty_percent),
         error_text(m, m.fem, m.error_same_mesh_percent), number(m.fem_error_percent, "{:+.2f}"),
         number(m.peer, "{:.6g}"));
  }
  for (const MeasuredValue& m : measures)
    for (const auto& [side, reason] : {std::pair("fem", &m.fem_reason), std::pair("msm", &m.msm_reason)})
      if (!reason->empty()) print(out, "  {}: no value of {}: {}\n", m.name, side, *reason);
}

} // namespace

void write_text(std::ostream& out, const Comparison& comparison) {
  const auto& [scene, answers, measures, gates, mesh_study, landmarks, surface] = comparison;
  const cases::Case& definition = scene.definition;
  print(out, "{}: {}\n", definition.name, definition.description);
  write_body(out, scene.mesh);
  write_loads(out, scene);
  for (const std::string& warning : cases::warnings_of_loads(scene)) print(out, "  warning: {}\n", warning);
  for (const std::string& remark : scene.remarks) print(out, "  warning: {}\n", remark);
  write_side(out, "fem",
             cases::name_of(answers.resolved.formulation) + " " + cases::name_of(definition.fem.element),
             answers.fem, definition.dynamics.has_value());
  for (const std::string& choice : answers.choices) print(out, "       {}\n", choice);
  if (const cases::Solution& msm = answers.msm.solution; answers.msm_source.empty())
    write_side(out, "msm", describe(answers.design, definition.msm.design), answers.msm,
               definition.dynamics.has_value());
  else
    print(out, "  msm  displacements of {} at {} nodes{}\n", answers.msm_source,
          comparison.scene.mesh.nodes.size(),
          msm.inverted_cells > 0 ? fmt::format(", {} INVERTED CELLS", msm.inverted_cells) : "");
  if (!answers.msm_source.empty() && !answers.msm.solution.message.empty())
    print(out, "       {}\n", answers.msm.solution.message);
  if (answers.interpolated) write_interpolated(out, comparison);
  for (const std::string& warning : answers.msm_warnings) print(out, "  warning: {}\n", warning);
  if (answers.design)
    for (const std::string& warning : answers.design->warnings) print(out, "  warning: {}\n", warning);
  if (answers.peer) write_peer(out, *answers.peer);
  for (const std::string& note : notes_on_motion(comparison)) print(out, "  {}\n", note);
  write_measures(out, measures, answers.peer);
  if (mesh_study) {
    write_missing_limits(out, *mesh_study);
    if (mesh_study->refine.size() > 1) write_mesh_study(out, *mesh_study);
  }
  write_landmarks_text(out, comparison);
  for (const std::string& doubt : comparison.doubts()) print(out, "  FAILED: {}\n", doubt);
  write_expectations_text(out, gates);
}

} // namespace springproof::compare
