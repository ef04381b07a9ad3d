#include "compare/write/write.hpp"

#include "cases/case/names.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/write/csv.hpp"
#include "compare/write/json.hpp"

#include <algorithm>
#include <fmt/ostream.h>

namespace springproof::compare {

using Json = nlohmann::ordered_json;

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

std::string describe(const std::optional<msm::DesignResult>& design, cases::Design method) {
  if (!design) return cases::name_of(method);
  const auto& [edge, face_diagonal, internal_diagonal, volume] = design->stiffness;
  return fmt::format("{} k_e, k_f, k_d = {:.4g}, {:.4g}, {:.4g} N/m{}", cases::name_of(method), 1e3 * edge,
                     1e3 * face_diagonal, 1e3 * internal_diagonal,
                     volume == 0 ? "" : fmt::format(", k_v = {:.4g} MPa", volume));
}

/// One line: what became of the peer, and how far it is from the finite elements.
void write_peer(std::ostream& out, const Peer& peer) {
  const cases::Solution& s = peer.answer.solution;
  fmt::print(out, "  peer {}: {}", peer.program, cases::name_of(s.status));
  if (s.status != cases::Status::converged) {
    fmt::print(out, ": {}\n", s.message);
    return;
  }
  fmt::print(out, ", {} unknowns, {} iterations, {:.3f} s", s.unknowns, s.newton_iterations,
             peer.answer.solve_seconds);
  if (peer.largest_difference)
    fmt::print(out, ", displacements within {:.1e} of fem's (of the largest)", *peer.largest_difference);
  fmt::print(out, "\n");
}

/// The reason that all measures share, if there is one: then it is told once.
std::string common_reason(const MeshStudy& study) {
  const auto same = [&](const StudiedMeasure& m) { return m.reason == study.measures.front().reason; };
  const bool is_common =
      !study.measures.empty() && std::all_of(study.measures.begin(), study.measures.end(), same);
  return is_common ? study.measures.front().reason : "";
}

/// A table of values, orders and error bars, or the one reason why there is none.
void write_mesh_study(std::ostream& out, const MeshStudy& study) {
  if (const std::string reason = common_reason(study); !reason.empty()) {
    fmt::print(out, "  no discretisation error: {}\n", reason);
    return;
  }
  fmt::print(out, "  fem on refined meshes    ");
  for (const int refine : study.refine) fmt::print(out, " {:>12}", fmt::format("refine {}", refine));
  fmt::print(out, " {:>7} {:>12} {:>10} {:>10}\n", "order", "limit", "GCI %", "fem +- %");
  for (const StudiedMeasure& measure : study.measures) {
    fmt::print(out, "  {:<24}", measure.name);
    for (const double value : measure.values) fmt::print(out, " {:>12.6g}", value);
    if (measure.limit)
      fmt::print(out, " {:>7.2f} {:>12.6g} {:>10.2g} {:>10.2g}\n", measure.limit->order,
                 measure.limit->extrapolated, measure.limit->index_percent,
                 *measure.discretisation_error_percent);
    else
      fmt::print(out, "  no limit: {}\n", measure.reason);
  }
}

/// Adds "discretisation_error_percent" (by measure, null where there is none), and "mesh_study" with the
/// values behind it and the reasons.
void add_mesh_study(Json& side, const MeshStudy& study) {
  Json errors = Json::object(), measures = Json::array();
  for (const StudiedMeasure& m : study.measures) {
    errors[m.name] = m.discretisation_error_percent;
    Json measure{{"name", m.name}, {"values", m.values}};
    if (m.limit) {
      measure["observed_order"] = m.limit->order;
      measure["extrapolated"] = m.limit->extrapolated;
      measure["grid_convergence_index_percent"] = m.limit->index_percent;
    }
    measure["reason"] = m.reason;
    measures.push_back(measure);
  }
  side["discretisation_error_percent"] = errors;
  side["mesh_study"] = {{"refine", study.refine}, {"unknowns", study.unknowns}, {"measures", measures}};
}

Json fem_to_json(const Comparison& comparison) {
  Json side = side_to_json(comparison.answers.fem);
  if (!comparison.answers.choices.empty()) side["choices"] = comparison.answers.choices;
  if (comparison.mesh_study) add_mesh_study(side, *comparison.mesh_study);
  return side;
}

Json msm_to_json(const Answers& answers) {
  Json side = side_to_json(answers.msm);
  if (!answers.msm_source.empty()) { // another program's: how it came by them is not known
    side["source"] = answers.msm_source;
    for (const char* key :
         {"unknowns", "residual", "newton_iterations", "linear_iterations", "relaxation_iterations"})
      side[key] = nullptr;
    side["seconds"] = {{"setup", nullptr}, {"solve", nullptr}};
  }
  if (answers.design) {
    const auto& [edge, face_diagonal, internal_diagonal, volume] = answers.design->stiffness;
    side["stiffness_N_per_m"] = {1e3 * edge, 1e3 * face_diagonal, 1e3 * internal_diagonal};
    side["volume_stiffness_MPa"] = volume;
    side["warnings"] = answers.design->warnings;
  }
  return side;
}

Json peer_to_json(const Peer& peer) {
  const cases::Solution& s = peer.answer.solution;
  return {{"program", peer.program},
          {"status", cases::name_of(s.status)},
          {"message", s.message},
          {"unknowns", s.unknowns},
          {"load_reached", s.load_reached},
          {"newton_iterations", s.newton_iterations},
          {"inverted_cells", s.inverted_cells},
          {"seconds", {{"solve", peer.answer.solve_seconds}}},
          {"largest_difference", peer.largest_difference}};
}

Json comparison_to_json(const Comparison& comparison) {
  Json measures = Json::array(), expectations = Json::array();
  for (const MeasuredValue& m : comparison.measures) {
    measures.push_back({{"name", m.name},
                        {"unit", m.unit},
                        {"fem", m.fem},
                        {"msm", m.msm},
                        {"error_percent", m.error_percent}});
    if (comparison.answers.peer) measures.back()["peer"] = m.peer;
  }
  for (const Gate& gate : comparison.gates)
    expectations.push_back({{"measure", gate.expectation.measure},
                            {"quantity", cases::name_of(gate.expectation.quantity)},
                            {"interval", gate.expectation.interval},
                            {"reference", cases::name_of(gate.expectation.reference)},
                            {"value", gate.value},
                            {"met", gate.met()},
                            {"reason", gate.missed}});
  Json document{{"name", comparison.scene.definition.name},
                {"description", comparison.scene.definition.description},
                {"fem", fem_to_json(comparison)},
                {"msm", msm_to_json(comparison.answers)},
                {"measures", measures},
                {"expectations", expectations},
                {"status", comparison.answers.failed() ? "failed" : "converged"}};
  if (comparison.answers.peer) document["peer"] = peer_to_json(*comparison.answers.peer);
  return document;
}

} // namespace

void write_text(std::ostream& out, const Comparison& comparison) {
  const auto& [scene, answers, measures, gates, mesh_study] = comparison;
  const cases::Case& definition = scene.definition;
  fmt::print(out, "{}: {}\n", definition.name, definition.description);
  write_side(out, "fem",
             cases::name_of(answers.resolved.formulation) + " " + cases::name_of(definition.fem.element),
             answers.fem);
  for (const std::string& choice : answers.choices) fmt::print(out, "       {}\n", choice);
  if (const cases::Solution& msm = answers.msm.solution; answers.msm_source.empty())
    write_side(out, "msm", describe(answers.design, definition.msm.design), answers.msm);
  else
    fmt::print(out, "  msm  displacements of {} at {} nodes{}\n", answers.msm_source, msm.displacement.size(),
               msm.inverted_cells > 0 ? fmt::format(", {} INVERTED CELLS", msm.inverted_cells) : "");
  if (answers.design)
    for (const std::string& warning : answers.design->warnings) fmt::print(out, "  warning: {}\n", warning);
  if (answers.peer) write_peer(out, *answers.peer);
  const auto in_column_of_peer = [&peer = answers.peer](const std::string& text) {
    return peer ? fmt::format(" {:>14}", text) : "";
  };
  fmt::print(out, "  {:<24} {:>4} {:>14} {:>14} {:>10}{}\n", "measure", "unit", "fem", "msm", "error %",
             in_column_of_peer(answers.peer ? answers.peer->program : ""));
  for (const MeasuredValue& m : measures)
    fmt::print(out, "  {:<24} {:>4} {:>14} {:>14} {:>10}{}\n", m.name, m.unit, number(m.fem, "{:.6g}"),
               number(m.msm, "{:.6g}"), number(m.error_percent, "{:+.2f}"),
               in_column_of_peer(number(m.peer, "{:.6g}")));
  if (mesh_study) write_mesh_study(out, *mesh_study);
  for (const Gate& gate : gates)
    fmt::print(out, "  {} {} ({}): {}\n", gate.met() ? "met   " : "MISSED", gate.expectation.measure,
               cases::name_of(gate.expectation.reference),
               gate.met() ? number(gate.value, "{:.6g}") : gate.missed);
}

Json side_to_json(const Answer& side) {
  const cases::Solution& s = side.solution;
  return {{"status", cases::name_of(s.status)},
          {"message", s.message},
          {"unknowns", s.unknowns},
          {"residual", s.residual},
          {"load_reached", s.load_reached},
          {"newton_iterations", s.newton_iterations},
          {"linear_iterations", s.linear_iterations},
          {"relaxation_iterations", s.relaxation_iterations},
          {"force_evaluations", s.force_evaluations},
          {"factorisations", s.factorisations},
          {"lowest_eigenvalue", s.lowest_eigenvalue},
          {"negative_eigenvalues", s.negative_eigenvalues},
          {"inverted_cells", s.inverted_cells},
          {"seconds", {{"setup", side.setup_seconds}, {"solve", side.solve_seconds}}}};
}

Json provenance() {
  const auto [processor, cores, system, compiler, blas] = describe_machine();
  return {{"schema", 1},
          {"program", {{"version", program_version()}, {"commit", program_commit()}}},
          {"machine",
           {{"processor", processor},
            {"cores", cores},
            {"system", system},
            {"compiler", compiler},
            {"blas", blas}}}};
}

Json to_json(const std::vector<Comparison>& comparisons) {
  Json document = provenance();
  document["cases"] = Json::array();
  for (const Comparison& comparison : comparisons)
    document["cases"].push_back(comparison_to_json(comparison));
  return document;
}

void write_csv(std::ostream& out, const std::vector<Comparison>& comparisons) {
  CsvWriter csv(out, 10);
  csv.row("case", "measure", "unit", "fem", "msm", "error_percent", "fem_status", "msm_status",
          "fem_discretisation_error_percent", "peer");
  for (const auto& [scene, answers, measures, gates, study] : comparisons)
    for (std::size_t i = 0; i < measures.size(); ++i) {
      const MeasuredValue& m = measures[i];
      csv.row(scene.definition.name, m.name, m.unit, m.fem, m.msm, m.error_percent,
              cases::name_of(answers.fem.solution.status), cases::name_of(answers.msm.solution.status),
              study ? study->measures[i].discretisation_error_percent : std::nullopt, m.peer);
    }
}

void write_vtu(std::ostream& out, const Comparison& comparison) {
  const cases::Solution &fem = comparison.answers.fem.solution, &msm = comparison.answers.msm.solution;
  std::vector<cases::PointField> displacements;
  std::vector<cases::CellField> volumes;
  const auto add = [&](const std::string& side, const cases::Solution& solution) {
    if (solution.displacement.empty()) return;
    displacements.push_back({side + "_displacement", solution.displacement});
    volumes.push_back({side + "_cell_volume", solution.cell_volume});
  };
  add("fem", fem);
  add("msm", msm);
  if (displacements.size() == 2) {
    std::vector<Eigen::Vector3d> difference = msm.displacement;
    for (std::size_t n = 0; n < difference.size(); ++n) difference[n] -= fem.displacement[n];
    displacements.push_back({"difference", difference});
  }
  out << cases::vtk().write_unstructured_grid(comparison.scene.mesh, displacements, volumes);
}

void write_vtu(std::ostream& out, const cases::HexMesh& mesh, const std::vector<cases::PointField>& fields) {
  out << cases::vtk().write_unstructured_grid(mesh, fields, {});
}

void write_results(const std::string& folder, const std::vector<Comparison>& done) {
  const Comparison& last = done.back();
  write_file(folder + "/" + last.scene.definition.name + ".vtu",
             [&](std::ostream& out) { write_vtu(out, last); });
  write_file(folder + "/comparison.csv", [&](std::ostream& out) { write_csv(out, done); });
  write_file(folder + "/results.json", [&](std::ostream& out) { out << to_json(done).dump(2) << '\n'; });
}

} // namespace springproof::compare
