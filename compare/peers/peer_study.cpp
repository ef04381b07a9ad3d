#include "compare/peers/peer_study.hpp"

#include "cases/case/names.hpp"
#include "compare/solve/solve.hpp"
#include "compare/table/table.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

/// The case as its finite elements were solved, with the measures that displacements tell. Its element has
/// the order of the peer's.
cases::Scene scene_for_peer(const Comparison& comparison) {
  cases::Scene scene = with_fem(comparison.scene, comparison.answers.resolved);
  auto& measures = scene.definition.measures;
  const auto is_of_fields = [](const cases::Measure& measure) { return cases::is_of_fields(measure.kind); };
  measures.erase(std::remove_if(measures.begin(), measures.end(), is_of_fields), measures.end());
  const bool is_tetrahedron = scene.mesh.shape == cases::CellShape::tetrahedron;
  scene.definition.fem.element = is_tetrahedron ? cases::Element::p2 : cases::Element::q2;
  return scene;
}

void add_limits(const Comparison& comparison, const MeshStudy& meshes, PeerStudy& study) {
  for (const StudiedMeasure& studied : meshes.measures) {
    const MeasuredValue* ours = find_named(comparison.measures, studied.name);
    study.limits.push_back(
        {studied.name, ours->unit, ours->fem_limit, studied.reference, studied.no_reference});
  }
}

std::string bar_text(const std::optional<Limit>& limit) {
  return limit ? fmt::format("{:.6g} +- {:.2g}", limit->value, limit->uncertainty) : "-";
}

Json limit_to_json(const PeerLimit& of) {
  const auto value = [](const auto& limit) { return limit ? Json(limit->value) : Json(); };
  const auto uncertainty = [](const auto& limit) { return limit ? Json(limit->uncertainty) : Json(); };
  return {{"measure", of.measure},
          {"unit", of.unit},
          {"fem_limit", value(of.ours)},
          {"fem_limit_uncertainty", uncertainty(of.ours)},
          {"limit", value(of.peer)},
          {"limit_uncertainty", uncertainty(of.peer)},
          {"note", of.peer ? of.peer->note : of.reason},
          {"difference_percent", of.difference_percent()},
          {"within_bars", of.is_within_bars()}};
}

} // namespace

std::optional<double> PeerLimit::difference_percent() const {
  if (!ours || !peer) return std::nullopt;
  return error_percent(ours->value, peer->value, 0);
}

std::optional<bool> PeerLimit::is_within_bars() const {
  if (!ours || !peer) return std::nullopt;
  return std::abs(peer->value - ours->value) <= ours->uncertainty + peer->uncertainty;
}

PeerStudy study_by_getfem(const Comparison& comparison, int most_meshes) {
  PeerStudy study;
  study.program = "GetFEM";
  const cases::Scene scene = scene_for_peer(comparison);
  Stopwatch stopwatch;
  try {
    const RefinedMeshes meshes = solve_with_getfem(scene, most_meshes);
    study.message = meshes.reason;
    if (meshes.solutions.empty()) return study; // skipped
    study.status = cases::Status::converged;
    study.refine = meshes.refine;
    const MeshStudy limits = study_meshes(scene, meshes, meshes.refine.front());
    study.unknowns = limits.unknowns;
    add_limits(comparison, limits, study);
  } catch (const std::runtime_error& error) { // a solve that failed, a folder that cannot be made or written
    study.status = cases::Status::failed;
    study.message = error.what();
  }
  study.seconds = stopwatch.lap();
  return study;
}

void write_peer_study_text(std::ostream& out, const PeerStudy& study) {
  const bool is_solved = study.status == cases::Status::converged;
  std::string text = fmt::format("  {}: {}", study.program, cases::name_of(study.status));
  if (is_solved)
    text += fmt::format(", {} meshes of up to {} unknowns, {:.3g} s", study.refine.size(),
                        study.unknowns.back(), study.seconds);
  if (!study.message.empty()) text += (is_solved ? "; no finer mesh: " : ": ") + study.message;
  write_wrapped(out, text, 4);
  if (study.limits.empty()) return;
  Json rows = Json::array();
  for (const PeerLimit& limit : study.limits) {
    const auto within = limit.is_within_bars();
    rows.push_back(limit_to_json(limit));
    rows.back().update(Json{{"ours", bar_text(limit.ours)},
                            {"peers", bar_text(limit.peer)},
                            {"within", !within   ? "-"
                                       : *within ? "yes"
                                                 : "NO"}});
  }
  write_table(out,
              columns_of("measure unit fem's~limit=ours " + study.program +
                         "'s~limit=peers apart~%=difference_percent{:+.2g} within~bars=within"),
              rows);
  for (const PeerLimit& limit : study.limits)
    if (!limit.peer) write_wrapped(out, fmt::format("  {}: no limit: {}", limit.measure, limit.reason), 4);
}

Json peer_study_to_json(const PeerStudy& study) {
  Json meshes = Json::array();
  for (std::size_t m = 0; m < study.refine.size(); ++m)
    meshes.push_back({{"refine", study.refine[m]}, {"unknowns", study.unknowns[m]}});
  return {{"program", study.program}, {"status", cases::name_of(study.status)},
          {"message", study.message}, {"seconds", study.seconds},
          {"meshes", meshes},         {"measures", json_list(study.limits, limit_to_json)}};
}

} // namespace springproof::compare
