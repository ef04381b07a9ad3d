#include "compare/error_bars/mesh_study.hpp"

#include "compare/measure/measure.hpp"
namespace springproof::compare {

namespace {

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

MeshStudy study_meshes(const cases::Scene& scene, const Answers& answers) {
  const RefinedMeshes& meshes = answers.refined.value();
  if (!meshes.reason.empty()) return without_values(scene, meshes.reason);
  MeshStudy study = without_values(scene, "");
  study.refine = meshes.refine;
  const auto own = static_cast<std::size_t>(answers.resolved.refine - study.refine.front());
  for (const cases::Solution& solution : meshes.solutions) study.unknowns.push_back(solution.unknowns);
  for (std::size_t m = 0; m < study.measures.size(); ++m) {
    for (const cases::Solution& solution : meshes.solutions)
      study.measures[m].values.push_back(evaluate(scene.definition.measures[m], scene, solution));
    judge(study.measures[m], own);
  }
  return study;
}

} // namespace springproof::compare
