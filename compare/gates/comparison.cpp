#include "compare/gates/comparison.hpp"

#include "compare/error_bars/auto_fem.hpp"

#include "cases/case/names.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace springproof::compare {

Comparison comparison_of(cases::Scene scene, Answers answers) {
  Comparison comparison;
  if (answers.refined) comparison.mesh_study = study_meshes(scene, *answers.refined, answers.resolved.refine);
  const MeshStudy* study = comparison.mesh_study ? &*comparison.mesh_study : nullptr;
  comparison.measures = measure(scene, answers, study);
  comparison.gates = judge(scene, answers, comparison.measures, study);
  comparison.landmarks = landmark_distances(scene, answers);
  comparison.surface_motion = surface_motion(scene, answers);
  comparison.scene = std::move(scene);
  comparison.answers = std::move(answers);
  return comparison;
}

Comparison compare_case(const cases::Case& definition, const Request& request) {
  cases::Scene scene = cases::make_scene(definition);
  Answers answers = solve(scene, request, solve_fem);
  return comparison_of(std::move(scene), std::move(answers));
}

std::vector<std::string> Comparison::doubts() const {
  std::vector<std::string> found;
  const auto examine = [&](const char* side, const Answer& answer,
                           const std::vector<cases::Doubt>& accepted) {
    const cases::Solution& solution = answer.solution;
    if (!answer.converged()) return;
    const auto doubt = [&](cases::Doubt kind, const std::string& what) {
      if (std::find(accepted.begin(), accepted.end(), kind) == accepted.end())
        found.push_back(fmt::format("{} {}, which the case does not accept ({}.accept = [\"{}\"])", side,
                                    what, side, cases::name_of(kind)));
    };
    if (solution.inverted_cells > 0)
      doubt(cases::Doubt::inverted, fmt::format("has {} inverted cells", solution.inverted_cells));
    if (solution.is_unstable()) doubt(cases::Doubt::unstable, "is in an unstable equilibrium");
  };
  examine("fem", answers.fem, scene.definition.fem.accepted);
  examine("msm", answers.msm, scene.definition.msm.accepted);
  return found;
}

std::vector<std::string> Comparison::failures() const {
  std::vector<std::string> found;
  if (gates.empty()) found.emplace_back("it expects nothing: there is no [[expect]]");
  for (const auto& [side, answer] : {std::pair("fem", &answers.fem), std::pair("msm", &answers.msm)})
    if (answer->solution.status == cases::Status::failed)
      found.push_back(describe_failure(side, answer->solution));
  for (std::string& doubt : doubts()) found.push_back(std::move(doubt));
  return found;
}

bool Comparison::is_sound() const {
  return !answers.failed() && doubts().empty() &&
         std::all_of(gates.begin(), gates.end(),
                     [](const Gate& gate) { return gate.met() || gate.is_left_out; });
}

bool Comparison::met() const {
  return failures().empty() &&
         std::all_of(gates.begin(), gates.end(), [](const Gate& gate) { return gate.met(); });
}

bool all_met(const std::vector<Comparison>& cases) {
  return std::all_of(cases.begin(), cases.end(), [](const Comparison& c) { return c.met(); });
}

} // namespace springproof::compare
