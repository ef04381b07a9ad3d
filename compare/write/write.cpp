#include "compare/write/write.hpp"

#include "cases/case/names.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/table/json.hpp"
#include "compare/table/table.hpp"

namespace springproof::compare {

namespace {

/// Adds "discretisation_error_percent" (by measure, null where there is none), and "mesh_study" with the
/// values behind it and the reasons.
void add_mesh_study(Json& side, const MeshStudy& study) {
  Json errors = Json::object();
  for (const StudiedMeasure& m : study.measures) errors[m.name] = m.discretisation_error_percent;
  side["discretisation_error_percent"] = errors;
  side["mesh_study"] = SPRINGPROOF_MEMBERS(study, refine, unknowns);
  side["mesh_study"]["measures"] = json_list(study.measures, studied_to_json);
}

/// Adds how a side came to the nodes, if it is the one that was interpolated.
void add_interpolated(Json& json, const Answers& answers, cases::Side side) {
  if (const auto& from = answers.interpolated; from && from->side == side)
    json["interpolated"] = {{"points", from->n_points},
                            {"nodes_outside", from->n_outside},
                            {"largest_distance_outside", from->largest_distance}};
}

Json fem_to_json(const Comparison& comparison) {
  Json side = side_to_json(comparison.answers.fem);
  add_interpolated(side, comparison.answers, cases::Side::fem);
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
  add_interpolated(side, answers, cases::Side::msm);
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

/// Null: it was not studied on several meshes.
const StudiedMeasure* studied_measure(const Comparison& comparison, const std::string& name) {
  return comparison.mesh_study ? find_named(comparison.mesh_study->measures, name) : nullptr;
}

Json measure_to_json(const Comparison& comparison, const MeasuredValue& m) {
  const std::optional<Limit>& limit = m.fem_limit;
  const StudiedMeasure* studied = studied_measure(comparison, m.name);
  const std::string reason = studied ? studied->no_reference : "no limit was asked for";
  Json json{{"name", m.name},
            {"unit", m.unit},
            {"reference", limit ? "limit" : "same_mesh"},
            {"fem", m.fem},
            {"fem_limit", limit ? Json(limit->value) : Json()},
            {"fem_limit_uncertainty", limit ? Json(limit->uncertainty) : Json()},
            {"fem_limit_note", limit ? limit->note : reason},
            {"msm", m.msm},
            {"error_percent", m.error_percent},
            {"error_is_norm", is_norm(m, comparison.scene.definition)}};
  json.update(SPRINGPROOF_MEMBERS(m, error_uncertainty_percent, error_same_mesh_percent, fem_error_percent,
                                  fem_reason, msm_reason));
  if (comparison.answers.peer) json["peer"] = m.peer;
  if (comparison.answers.interpolated)
    json.update(SPRINGPROOF_MEMBERS(m, interpolation_error, interpolation_error_percent));
  return json;
}

Json measures_to_json(const Comparison& comparison) {
  return json_list(comparison.measures,
                   [&](const MeasuredValue& m) { return measure_to_json(comparison, m); });
}

/// FOLDER/NAME_landmarks.csv.  @throws InputError if it cannot be written
void write_landmarks(const std::string& folder, const Comparison& comparison) {
  const std::string file = folder + "/" + comparison.scene.definition.name + "_landmarks.csv";
  std::error_code not_there;
  if (comparison.landmarks.empty())
    std::filesystem::remove(file, not_there); // an earlier run's
  else
    write_file(file, [&](std::ostream& out) { write_landmarks_csv(out, comparison); });
}

} // namespace

std::string status_of(const cases::Solution& solution) {
  return solution.is_equilibrium() ? cases::name_of(solution.status) : "not_in_equilibrium";
}

Json case_to_json(const Comparison& comparison) {
  Json document{{"name", comparison.scene.definition.name},
                {"description", comparison.scene.definition.description},
                {"body", body_to_json(comparison.scene)},
                {"loads", loads_to_json(comparison.scene)},
                {"fem", fem_to_json(comparison)},
                {"msm", msm_to_json(comparison.answers)},
                {"measures", measures_to_json(comparison)},
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

Json side_to_json(const Answer& answer) {
  const cases::Solution& s = answer.solution;
  Json from_equilibrium;
  if (const auto& from = s.from_equilibrium)
    from_equilibrium = {
        {"is_equilibrium", s.is_equilibrium()},
        {"largest_mm", from->largest},
        {"root_mean_square_mm", from->root_mean_square},
        {"reason", from->reason},
        {"rest", from->rest ? Json{{"seconds", from->rest->time}, {"steps", from->rest->steps}} : Json()}};
  Json steps;
  if (const auto& motion = s.trajectory)
    steps = {{"taken", motion->time.size() - 1},
             {"halved", motion->halved_steps},
             {"unfinished", motion->unfinished_steps},
             {"largest_residual", motion->largest_residual}};
  Json side{{"status", status_of(s)}};
  side.update(SPRINGPROOF_MEMBERS(s, message, unknowns, residual, load_reached, newton_iterations,
                                  linear_iterations, relaxation_iterations, force_evaluations, factorisations,
                                  lowest_eigenvalue, negative_eigenvalues, inverted_cells));
  side.update({{"from_equilibrium", from_equilibrium},
               {"steps", steps},
               {"seconds", {{"setup", answer.setup_seconds}, {"solve", answer.solve_seconds}}}});
  return side;
}

Json provenance() {
  return {{"schema", 1},
          {"program", {{"version", program_version()}, {"commit", program_commit()}}},
          {"machine", SPRINGPROOF_MEMBERS(describe_machine(), processor, cores, system, compiler, blas)}};
}

Json to_json(const std::vector<Comparison>& comparisons) {
  Json document = provenance();
  document["cases"] = json_list(comparisons, case_to_json);
  return document;
}

Json studied_to_json(const StudiedMeasure& measure) {
  Json json = SPRINGPROOF_MEMBERS(measure, name, values);
  if (const auto& limit = measure.limit)
    json.update({{"observed_order", limit->order},
                 {"extrapolated", limit->extrapolated},
                 {"grid_convergence_index_percent", limit->index_percent}});
  json["reason"] = measure.reason;
  return json;
}

Json landmarks_to_json(const Comparison& comparison) {
  Json list = Json::array();
  for (std::size_t i = 0; i < comparison.landmarks.size(); ++i) {
    const LandmarkDistance& landmark = comparison.landmarks[i];
    const Eigen::Vector3d& point = comparison.scene.definition.landmarks[i].point;
    const auto& own = landmark.to_equilibrium;
    list.push_back({{"name", landmark.name},
                    {"point", {point.x(), point.y(), point.z()}},
                    {"from_point", landmark.from_point}});
    list.back().update(SPRINGPROOF_MEMBERS(landmark.to_fem, n_rays, mean, deviation));
    list.back().update({{"moved", landmark.moved},
                        {"to_equilibrium", own ? SPRINGPROOF_MEMBERS(*own, n_rays, mean, deviation) : Json()},
                        {"reason", landmark.missing}});
  }
  return list;
}

void write_landmarks_csv(std::ostream& out, const Comparison& comparison) {
  Json rows = landmarks_to_json(comparison);
  for (Json& row : rows) row["case"] = comparison.scene.definition.name;
  write_csv(
      out,
      columns_of("case landmark=name x=point.0 y=point.1 z=point.2 from_point n_rays mean deviation moved "
                 "to_equilibrium_mean=to_equilibrium.mean to_equilibrium_deviation=to_equilibrium.deviation"),
      rows);
}

void write_csv(std::ostream& out, const std::vector<Comparison>& comparisons) {
  Json rows = Json::array();
  for (const Comparison& comparison : comparisons)
    for (Json& row : measures_to_json(comparison)) {
      const StudiedMeasure* studied = studied_measure(comparison, row["name"]);
      row.update({{"case", comparison.scene.definition.name},
                  {"fem_status", cases::name_of(comparison.answers.fem.solution.status)},
                  {"msm_status", status_of(comparison.answers.msm.solution)},
                  {"discretisation", studied ? studied->discretisation_error_percent : std::nullopt}});
      rows.push_back(std::move(row));
    }
  write_csv(out,
            columns_of("case measure=name unit fem msm error_percent fem_status msm_status "
                       "fem_discretisation_error_percent=discretisation peer reference fem_limit "
                       "fem_limit_uncertainty error_uncertainty_percent error_same_mesh_percent"),
            rows);
}

void write_results(const std::string& folder, const std::vector<Comparison>& done) {
  write_fields(folder, done.back());
  if (mpi_rank() != 0) return;
  write_motion(folder, done.back());
  write_landmarks(folder, done.back());
  write_file(folder + "/comparison.csv", [&](std::ostream& out) { write_csv(out, done); });
  write_json_file(folder + "/results.json", to_json(done));
}

} // namespace springproof::compare
