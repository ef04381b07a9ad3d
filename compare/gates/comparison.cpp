#include "compare/gates/comparison.hpp"

#include "compare/error_bars/auto_fem.hpp"

namespace springproof::compare {

Comparison comparison_of(cases::Scene scene, Answers answers) {
  Comparison comparison;
  comparison.measures = measure(scene, answers);
  if (answers.refined) comparison.mesh_study = study_meshes(scene, answers);
  const MeshStudy* study = comparison.mesh_study ? &*comparison.mesh_study : nullptr;
  comparison.gates = judge(scene, answers, comparison.measures, study);
  comparison.scene = std::move(scene);
  comparison.answers = std::move(answers);
  return comparison;
}

Comparison compare_case(const cases::Case& definition, const Request& request) {
  cases::Scene scene = cases::make_scene(definition);
  Answers answers = solve(scene, request, solve_fem);
  return comparison_of(std::move(scene), std::move(answers));
}

} // namespace springproof::compare
