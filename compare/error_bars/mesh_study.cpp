#include "compare/error_bars/mesh_study.hpp"

#include "compare/measure/measure.hpp"
#include "fem_reference/model.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

/// Every node of the region belongs to a face of it: what is shared by more and more nodes tends to a
/// traction.
bool is_area(const cases::Selection& selection) {
  std::vector<int> on_faces;
  for (const auto& face : selection.faces) on_faces.insert(on_faces.end(), face.begin(), face.end());
  std::sort(on_faces.begin(), on_faces.end());
  return std::all_of(selection.nodes.begin(), selection.nodes.end(),
                     [&](int node) { return std::binary_search(on_faces.begin(), on_faces.end(), node); });
}

MeshStudy without_values(const cases::Scene& scene, const std::string& reason) {
  MeshStudy study;
  for (const cases::Measure& measure : scene.definition.measures)
    study.measures.push_back({measure.name, {}, std::nullopt, std::nullopt, reason});
  return study;
}

void judge(StudiedMeasure& measure, std::size_t own) {
  const MeshVerdict verdict = judge_refinement(measure.values, 2);
  if (const auto* limit = std::get_if<MeshLimit>(&verdict)) {
    measure.limit = *limit;
    measure.discretisation_error_percent = discretisation_error_percent(measure.values[own], *limit);
  } else {
    measure.reason = std::get<std::string>(verdict);
  }
}

} // namespace

std::optional<std::string> reason_without_continuum_limit(const cases::Scene& scene) {
  for (std::size_t i = 0; i < scene.loads.size(); ++i) {
    const auto& [selection, load] = scene.loads[i];
    const bool is_point_force = load.kind == cases::LoadKind::nodal_force ||
                                (load.kind == cases::LoadKind::total_force && !is_area(selection));
    if (is_point_force && !load.value.isZero(0))
      return fmt::format(
          "load[{}] is a concentrated force (on points or edges), which has no continuum limit: the "
          "displacement under it grows without bound as the mesh is refined; use a traction",
          i);
  }
  return std::nullopt;
}

MeshStudy study_meshes(const cases::Scene& scene, const cases::Solution& own, int n_meshes) {
  if (const auto reason = reason_without_continuum_limit(scene)) return without_values(scene, *reason);
  if (own.status != cases::Status::converged)
    return without_values(scene, "the case's own mesh was not solved");
  const auto& measures = scene.definition.measures;
  MeshStudy study = without_values(scene, "");
  const int own_refine = scene.definition.fem.refine;
  const int finest = std::max(n_meshes - 1, own_refine);
  for (int refine = finest - n_meshes + 1; refine <= finest; ++refine) {
    cases::Solution solution = own;
    if (refine != own_refine) {
      cases::Scene refined = scene;
      refined.definition.fem.refine = refine;
      try {
        solution = fem_reference::Model(refined, MPI_COMM_WORLD).solve();
      } catch (const cases::SolveError& error) {
        return without_values(
            scene, fmt::format("the mesh refined {} times was not solved: {}", refine, error.what()));
      }
    }
    study.refine.push_back(refine);
    study.unknowns.push_back(solution.unknowns);
    for (std::size_t m = 0; m < measures.size(); ++m)
      study.measures[m].values.push_back(evaluate(measures[m], scene, solution));
  }
  const auto own_mesh = static_cast<std::size_t>(own_refine - study.refine.front());
  for (StudiedMeasure& measure : study.measures) judge(measure, own_mesh);
  return study;
}

} // namespace springproof::compare
