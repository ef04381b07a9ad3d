#include "compare/gates/comparison.hpp"

#include "compare/error_bars/auto_fem.hpp"

#include <algorithm>

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

std::vector<std::string> Comparison::failures() const {
  std::vector<std::string> found;
  if (gates.empty()) found.emplace_back("it expects nothing: there is no [[expect]]");
  for (const auto& [side, answer] : {std::pair("fem", &answers.fem), std::pair("msm", &answers.msm)})
    if (answer->solution.status == cases::Status::failed)
      found.push_back(describe_failure(side, answer->solution));
  return found;
}

bool Comparison::met() const {
  return failures().empty() &&
         std::all_of(gates.begin(), gates.end(), [](const Gate& gate) { return gate.met(); });
}

bool all_met(const std::vector<Comparison>& cases) {
  return std::all_of(cases.begin(), cases.end(), [](const Comparison& c) { return c.met(); });
}

bool asks_for_mesh_study(const cases::Case& definition) {
  return std::any_of(definition.expectations.begin(), definition.expectations.end(),
                     [](const auto& expected) {
                       return expected.reference == cases::ReferenceKind::converged &&
                              expected.quantity != cases::Quantity::msm;
                     });
}

} // namespace springproof::compare
