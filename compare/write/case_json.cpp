#include "compare/write/case_json.hpp"

#include "cases/case/names.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/table/json.hpp"
#include "compare/write/measures_text.hpp"
#include "compare/write/scene_text.hpp"
#include "compare/write/springs_text.hpp"
#include "compare/write/warnings.hpp"
#include "compare/write/write_gates.hpp"
#include "compare/write/write_landmarks.hpp"
#include "compare/write/write_motion.hpp"

#include <nlohmann/json.hpp>

namespace springproof::compare {

namespace {

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
    side["warnings"] = answers.msm_warnings;
    for (const char* key :
         {"unknowns", "residual", "newton_iterations", "linear_iterations", "relaxation_iterations"})
      side[key] = nullptr;
    side["seconds"] = {{"setup", nullptr}, {"solve", nullptr}};
  }
  if (answers.interpolated)
    side["interpolated"] = {{"points", answers.interpolated->n_points},
                            {"nodes_outside", answers.interpolated->n_outside},
                            {"largest_distance_outside", answers.interpolated->largest_distance}};
  if (answers.design) {
    side.update(springs_to_json(*answers.design));
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

} // namespace

std::string status_of(const cases::Solution& solution) {
  return solution.is_equilibrium() ? cases::name_of(solution.status) : "not_in_equilibrium";
}

Json case_to_json(const Comparison& comparison) {
  Json measures = Json::array();
  for (const MeasuredValue& m : comparison.measures) {
    const std::optional<Limit>& limit = m.fem_limit;
    const StudiedMeasure* studied =
        comparison.mesh_study ? find_named(comparison.mesh_study->measures, m.name) : nullptr;
    const std::string reason = studied ? studied->no_reference : "no limit was asked for";
    measures.push_back({{"name", m.name},
                        {"unit", m.unit},
                        {"reference", m.fem_limit ? "limit" : "same_mesh"},
                        {"fem", m.fem},
                        {"fem_limit", limit ? Json(limit->value) : Json()},
                        {"fem_limit_uncertainty", limit ? Json(limit->uncertainty) : Json()},
                        {"fem_limit_note", limit ? limit->note : reason},
                        {"msm", m.msm},
                        {"error_percent", m.error_percent},
                        {"error_is_norm", is_norm(m, comparison.scene.definition)},
                        {"error_uncertainty_percent", m.error_uncertainty_percent},
                        {"error_same_mesh_percent", m.error_same_mesh_percent},
                        {"fem_error_percent", m.fem_error_percent},
                        {"fem_reason", m.fem_reason},
                        {"msm_reason", m.msm_reason}});
    if (comparison.answers.peer) measures.back()["peer"] = m.peer;
    if (comparison.answers.interpolated) {
      measures.back()["interpolation_error"] = m.interpolation_error;
      measures.back()["interpolation_error_percent"] = m.interpolation_error_percent;
    }
  }
  Json document{{"name", comparison.scene.definition.name},
                {"description", comparison.scene.definition.description},
                {"body", body_to_json(comparison.scene)},
                {"loads", loads_to_json(comparison.scene)},
                {"fem", fem_to_json(comparison)},
                {"msm", msm_to_json(comparison.answers)},
                {"measures", measures},
                {"expectations", expectations_to_json(comparison.gates)},
                {"status", comparison.answers.failed() ? "failed" : "converged"},
                {"doubts", comparison.doubts()},
                {"remarks", comparison.scene.remarks},
                {"warnings", warnings_of(comparison)}};
  if (!comparison.landmarks.empty()) document["landmarks"] = landmarks_to_json(comparison);
  if (comparison.scene.definition.dynamics) document["motion"] = motion_to_json(comparison);
  if (comparison.answers.peer) document["peer"] = peer_to_json(*comparison.answers.peer);
  return document;
}

Json side_to_json(const Answer& side) {
  const cases::Solution& s = side.solution;
  Json from_equilibrium;
  if (const auto& from = s.from_equilibrium)
    from_equilibrium = {{"is_equilibrium", s.is_equilibrium()},
                        {"largest_mm", from->largest},
                        {"root_mean_square_mm", from->root_mean_square},
                        {"reason", from->reason}};
  Json steps;
  if (const auto& motion = s.trajectory)
    steps = {{"taken", motion->time.size() - 1},
             {"halved", motion->halved_steps},
             {"unfinished", motion->unfinished_steps},
             {"largest_residual", motion->largest_residual}};
  return {{"status", status_of(s)},
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
          {"from_equilibrium", from_equilibrium},
          {"steps", steps},
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
  for (const Comparison& comparison : comparisons) document["cases"].push_back(case_to_json(comparison));
  return document;
}

} // namespace springproof::compare
