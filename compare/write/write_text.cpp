#include "compare/write/write.hpp"

#include "cases/case/names.hpp"
#include "cases/case/read_case.hpp"
#include "cases/scene/loads.hpp"
#include "cases/scene/tools.hpp"
#include "compare/measure/measure.hpp"
#include "compare/provenance/print.hpp"
#include "compare/table/table.hpp"

#include <algorithm>
#include <fmt/format.h>
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
/// @param method  of its steps in real time; empty: its equations were solved
std::string effort_text(const Answer& side, const std::string& method) {
  const cases::Solution& s = side.solution;
  const bool is_relaxed = s.relaxation_iterations > 0;
  const long n_iterations = is_relaxed       ? s.relaxation_iterations
                            : method.empty() ? s.newton_iterations
                                             : s.linear_iterations;
  const std::string kind = !method.empty() ? method + " " : is_relaxed ? "explicit " : "Newton ";
  std::string text =
      fmt::format("{}, {} unknowns, {} {}iteration{}, {:.3g} s",
                  s.is_equilibrium() ? cases::name_of(s.status) : "not in equilibrium", s.unknowns,
                  n_iterations, kind, n_iterations == 1 ? "" : "s", side.seconds());
  if (!s.is_equilibrium()) text += fmt::format(", residual {:.1e}", s.residual);
  if (!method.empty() && s.trajectory)
    text +=
        fmt::format(", a step leaves {:.2g} % of the forces at most", 100 * s.trajectory->largest_residual);
  text += inverted_text(s);
  if (s.negative_eigenvalues.value_or(0) > 0)
    text += fmt::format(", unstable: {} negative eigenvalues of the tangent", *s.negative_eigenvalues);
  if (s.lowest_eigenvalue)
    text += fmt::format(", lowest tangent eigenvalue {:.3g} N/mm", *s.lowest_eigenvalue);
  return text;
}

void write_side(std::ostream& out, const std::string& label, const std::string& what, const Answer& side,
                bool is_motion, const std::string& method) {
  const cases::Solution& s = side.solution;
  if (s.status == cases::Status::skipped) return;
  if (s.status == cases::Status::failed) {
    write_labelled(out, label,
                   fmt::format("{}: failed at {:.4g} of the {}: {}", what, s.load_reached,
                               is_motion ? "time" : "load", s.message));
    return;
  }
  write_labelled(out, label, what + ": " + effort_text(side, method));
  if (s.trajectory) write_motion_text(out, *s.trajectory, side.solve_seconds);
  if (!s.message.empty()) write_below(out, s.message);
}

/// Estimates of what results on another mesh have lost on the way to this one.
std::string interpolation_text(const std::vector<MeasuredValue>& measures, cases::Side side) {
  std::string text =
      fmt::format("the interpolation adds up to ({}):",
                  side == cases::Side::fem ? "against quadratic functions"
                                           : "fem's displacement, interpolated there and back");
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
                       ? interpolation_text(comparison.measures, from.side)
                       : "the interpolation's error is not known: fem has no displacement to try it on");
}

void write_fem(std::ostream& out, const Comparison& comparison) {
  const cases::Case& definition = comparison.scene.definition;
  const Answers& answers = comparison.answers;
  const auto& real_time = definition.fem.real_time;
  const bool has_own_law = real_time && real_time->method != cases::ElementMethod::total_lagrangian_explicit;
  const std::string method = real_time ? cases::name_of(real_time->method) : "",
                    law = has_own_law ? method : cases::name_of(answers.resolved.formulation);
  write_side(out, "fem", law + " " + cases::name_of(definition.fem.element), answers.fem,
             definition.dynamics.has_value(), method);
  if (answers.interpolated && answers.interpolated->side == cases::Side::fem)
    write_interpolated(out, comparison);
  for (const std::string& choice : answers.choices) write_below(out, choice);
}

std::string describe(const std::optional<msm::DesignResult>& design, cases::Design method) {
  if (!design) return cases::name_of(method);
  return cases::name_of(method) + " with " + springs_text(*design);
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
               definition.dynamics.has_value(),
               definition.msm.real_time ? cases::name_of(definition.msm.real_time->method) : "");
  else
    write_external(out, comparison);
  if (answers.interpolated && answers.interpolated->side == cases::Side::msm)
    write_interpolated(out, comparison);
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

std::string number(const std::optional<double>& value, const char* format) {
  return value ? fmt::format(fmt::runtime(format), *value) : "-";
}

/// "9.23 +- 1.1", or without the error bar; "-" when there is no value.
std::string with_bar(const std::optional<double>& value, const char* format,
                     const std::optional<double>& bar) {
  return number(value, format) + (bar ? fmt::format(" +- {:.2g}", *bar) : "");
}

/// An error; of a measure whose reference is zero there is none. The norm of a difference is marked.
std::string error_text(const MeasuredValue& measure, bool is_of_difference) {
  const std::optional<double> reference =
      measure.fem_limit ? std::optional(measure.fem_limit->value) : measure.fem;
  if (!measure.error_percent && reference && measure.msm) return "no percentage";
  if (!is_of_difference) return with_bar(measure.error_percent, "{:+.2f}", measure.error_uncertainty_percent);
  return with_bar(measure.error_percent, "{:.2f}", measure.error_uncertainty_percent) +
         (measure.error_percent ? "*" : "");
}

void write_measures_table(std::ostream& out, const Comparison& comparison) {
  const std::vector<MeasuredValue>& measures = comparison.measures;
  const auto& peer = comparison.answers.peer;
  const bool has_limits = std::any_of(measures.begin(), measures.end(),
                                      [](const MeasuredValue& m) { return m.fem_limit.has_value(); });
  const Json rows = json_list(measures, [&](const MeasuredValue& m) {
    const bool is_of_difference = is_norm(m, comparison.scene.definition);
    const auto& limit = m.fem_limit;
    Json row = SPRINGPROOF_MEMBERS(m, name, unit, fem, msm, peer);
    row.update({{"limit", limit ? with_bar(limit->value, "{:.6g}", limit->uncertainty) : "-"},
                {"error", error_text(m, is_of_difference)},
                {"fem_error", number(m.fem_error_percent, is_of_difference ? "{:.2f}*" : "{:+.2f}")}});
    return row;
  });
  Columns columns =
      columns_of(std::string("measure=name unit fem{:.6g} springs=msm{:.6g} ") +
                 (has_limits ? "fem's~limit=limit error~%=error fem's~error~%=fem_error" : "error~%=error"));
  columns[3].heading = comparison.answers.msm_name;
  if (peer) columns.push_back({peer->program, "peer", "{:.6g}"});
  write_table(out, columns, rows);
}

/// Tells why errors are against the same mesh, once where all measures have the same reason.
void write_missing_limits(std::ostream& out, const MeshStudy& study) {
  if (study.measures.empty()) return;
  const std::string& reason = study.measures.front().no_reference;
  const auto has_it = [&](const StudiedMeasure& m) { return m.no_reference == reason; };
  if (!reason.empty() && std::all_of(study.measures.begin(), study.measures.end(), has_it)) {
    write_wrapped(out, "  errors are against the finite elements on the same mesh: " + reason, 4);
    return;
  }
  for (const StudiedMeasure& m : study.measures)
    if (!m.reference)
      write_wrapped(out, "  " + m.name + ": error against the same mesh: " + m.no_reference, 4);
}

void write_missing_values(std::ostream& out, const MeasuredValue& m) {
  for (const auto& [side, reason] : {std::pair("fem", &m.fem_reason), std::pair("springs", &m.msm_reason)})
    if (!reason->empty())
      write_wrapped(out, fmt::format("  {}: no value of {}: {}", m.name, side, *reason), 4);
}

/// Writes one line a measure: both models, the limit where there is one, the errors against it and of the
/// finite elements themselves. Then what the errors are against, and why values are missing.
void write_measures_text(std::ostream& out, const Comparison& comparison) {
  if (comparison.measures.empty()) return;
  write_measures_table(out, comparison);
  if (std::any_of(comparison.measures.begin(), comparison.measures.end(), [&](const MeasuredValue& m) {
        return m.error_percent && is_norm(m, comparison.scene.definition);
      }))
    write_wrapped(out,
                  "  * of a field over the body, or of a course over time: the norm of the difference, which "
                  "has no sign",
                  4);
  if (comparison.mesh_study) write_missing_limits(out, *comparison.mesh_study);
  for (const MeasuredValue& m : comparison.measures) write_missing_values(out, m);
}

/// The study on its finest meshes.
Columns study_columns(const MeshStudy& study, std::size_t n_meshes) {
  std::string columns = "fem~on~refined~meshes=name";
  for (std::size_t mesh = study.refine.size() - n_meshes; mesh < study.refine.size(); ++mesh)
    columns += fmt::format(" refine~{}=values.{}{{:.6g}}", study.refine[mesh], mesh);
  return columns_of(columns + " order=observed_order{:.2f} limit=extrapolated{:.6g} "
                              "GCI~%=grid_convergence_index_percent{:.2g} "
                              "fem~+-~%=discretisation_error{:.2g}");
}

/// Writes the finite elements' values on every mesh, with orders and error bars. In a terminal's width the
/// finest meshes alone.
void write_mesh_study_text(std::ostream& out, const MeshStudy& study) {
  std::size_t n_meshes = study.refine.size();
  if (n_meshes < 2) return;
  const Json rows = json_list(study.measures, [](const StudiedMeasure& measure) {
    Json row = studied_to_json(measure);
    if (measure.limit) row["discretisation_error"] = measure.discretisation_error_percent;
    return row;
  });
  while (n_meshes > 3 && table_width(study_columns(study, n_meshes), rows) > screen_width) --n_meshes;
  write_table(out, study_columns(study, n_meshes), rows);
  if (n_meshes < study.refine.size())
    write_wrapped(out, "  values on coarser meshes: in --json, and in results.json of --out", 4);
  for (const StudiedMeasure& measure : study.measures)
    if (!measure.limit)
      write_wrapped(out, fmt::format("  {}: no order: {}", measure.name, measure.reason), 4);
}

} // namespace

void write_landmarks_text(std::ostream& out, const Comparison& comparison) {
  if (comparison.landmarks.empty()) return;
  Json rows = Json::array(), missing = Json::array();
  bool has_equilibrium = false; // springs after a number of iterations have another one besides
  for (const Json& row : landmarks_to_json(comparison)) {
    const bool is_to_equilibrium = !row["to_equilibrium"].is_null();
    (row["reason"] == "" || is_to_equilibrium ? rows : missing).push_back(row);
    has_equilibrium = has_equilibrium || is_to_equilibrium;
  }
  std::string columns = "landmark,~mm=name springs~to~fem=mean{:.4g} deviation{:.4g} rays=n_rays "
                        "fem~moved=moved{:.4g}";
  if (has_equilibrium)
    columns += " to~their~equilibrium=to_equilibrium.mean{:.4g} deviation=to_equilibrium.deviation{:.4g}";
  write_table(out, columns_of(columns), rows);
  for (const Json& row : missing)
    write_wrapped(
        out, fmt::format("  {}: {}", row["name"].get<std::string>(), row["reason"].get<std::string>()), 4);
}

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

bool is_norm(const MeasuredValue& measured, const cases::Case& definition) {
  const cases::Measure* measure = find_named(definition.measures, measured.name);
  return measure ? is_field_norm(measure->kind) || is_trajectory_norm(*measure)
                 : measured.name == cases::surface_measure;
}

namespace {

/// Radius of a tool; of a plane and of a file's surface none is known.
std::optional<double> radius_of(const cases::Tool& tool) {
  return std::visit(
      [](const auto& shape) -> std::optional<double> {
        if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, cases::tools::Sphere> ||
                      std::is_same_v<std::decay_t<decltype(shape)>, cases::tools::Cylinder> ||
                      std::is_same_v<std::decay_t<decltype(shape)>, cases::tools::Punch>)
          return shape.radius;
        return std::nullopt;
      },
      tool.shape);
}

/// Tools that are thinner than the faces they may touch: nodes go round such a tool to its other side.
std::vector<std::string> tools_thinner_than_cells(const cases::Scene& scene) {
  std::vector<std::string> all;
  for (const cases::Tool& tool : scene.definition.tools) {
    const std::optional<double> radius = radius_of(tool);
    if (!radius) continue;
    if (const double side = cases::shortest_side(scene, tool); *radius < side)
      all.push_back(
          fmt::format("the tool '{}' has a radius of {:g} mm, less than every side of the faces that "
                      "it may touch, {:g} mm: nodes can go round it, and its force be wrong; refine the "
                      "mesh",
                      tool.name, *radius, side));
  }
  return all;
}

/// Whether a tool touches the body in a solution, at any time of a motion.
bool touches(const cases::Solution& solution, std::size_t tool, std::size_t n_tools) {
  const auto& in_time = solution.trajectory ? solution.trajectory->tools : solution.tools;
  for (std::size_t i = tool; i < in_time.size(); i += n_tools)
    if (!in_time[i].force.isZero(0)) return true;
  return in_time.empty(); // it is not known
}

std::vector<std::string> tools_without_touch(const Comparison& comparison) {
  const std::vector<cases::Tool>& tools = comparison.scene.definition.tools;
  std::vector<std::string> all;
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    const auto misses = [&](const Answer& side) {
      return side.converged() && !touches(side.solution, tool, tools.size());
    };
    if (misses(comparison.answers.fem) || misses(comparison.answers.msm))
      all.push_back(
          fmt::format("the tool '{}' touches nothing: look at its place, its displacement and, if it is "
                      "of a file, its scale",
                      tools[tool].name));
  }
  return all;
}

} // namespace

std::vector<std::string> warnings_of(const Comparison& comparison) {
  std::vector<std::string> all = cases::warnings_of_loads(comparison.scene);
  const auto add = [&all](const std::vector<std::string>& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  add(comparison.scene.remarks);
  add(comparison.answers.msm_warnings);
  if (const auto& design = comparison.answers.design) add(design->warnings);
  add(tools_thinner_than_cells(comparison.scene));
  add(tools_without_touch(comparison));
  return all;
}

} // namespace springproof::compare
