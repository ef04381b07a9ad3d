#include "compare/solve/answer_bytes.hpp"

#include "compare/solve/fields.hpp"

#include <cmath>
#include <stdexcept>

namespace springproof::compare {

namespace {

/// As many finite values as the share has nodes and cells, where there are any.
bool fit(const std::optional<cases::Fields>& fields, const cases::Share& share) {
  if (!fields) return true;
  const auto is_finite = [](const cases::SymmetricTensor& tensor) {
    return std::all_of(tensor.begin(), tensor.end(), [](double value) { return std::isfinite(value); });
  };
  const auto& [reaction, total_energy, has_stress, energy, stress, strain] = *fields;
  const std::size_t n_of_stress = has_stress ? share.cells.size() : 0;
  return reaction.size() == share.nodes.size() && energy.size() == n_of_stress &&
         stress.size() == n_of_stress && strain.size() == share.cells.size() && std::isfinite(total_energy) &&
         std::all_of(reaction.begin(), reaction.end(),
                     [](const Eigen::Vector3d& force) { return force.allFinite(); }) &&
         std::all_of(energy.begin(), energy.end(), [](double value) { return std::isfinite(value); }) &&
         std::all_of(stress.begin(), stress.end(), is_finite) &&
         std::all_of(strain.begin(), strain.end(), is_finite);
}

/// @throws std::runtime_error if a solution has not as many values as the share has nodes and cells
void check(const cases::Solution& solution, const cases::Share& share) {
  const auto is_empty_or = [&](std::size_t size, std::size_t expected) {
    return size == expected || (size == 0 && solution.status != cases::Status::converged);
  };
  const bool is_finite = std::all_of(solution.displacement.begin(), solution.displacement.end(),
                                     [](const Eigen::Vector3d& u) { return u.allFinite(); }) &&
                         std::all_of(solution.cell_volume.begin(), solution.cell_volume.end(),
                                     [](double volume) { return std::isfinite(volume); });
  if (!fit(solution.fields, share))
    throw std::runtime_error("has fields that are not those of the case's mesh");
  if (!is_empty_or(solution.displacement.size(), share.nodes.size()) ||
      !is_empty_or(solution.cell_volume.size(), share.cells.size()) || !is_finite)
    throw std::runtime_error("has values that are no solution on the case's mesh");
}

} // namespace

Answers answers_from(const std::string& bytes, const cases::Share& share) {
  Answers answers;
  cases::from_bytes(bytes, answers);
  check(answers.fem.solution, share);
  check(answers.msm.solution, share);
  if (answers.peer) check(answers.peer->answer.solution, share);
  if (!answers.refined) return answers;
  if (answers.refined->solutions.size() != answers.refined->refine.size())
    throw std::runtime_error("has not as many refined solutions as meshes");
  for (const cases::Solution& solution : answers.refined->solutions) check(solution, share);
  return answers;
}

Answer answer_from(const std::string& bytes, const cases::Share& share) {
  Answer answer;
  cases::from_bytes(bytes, answer);
  check(answer.solution, share);
  return answer;
}

} // namespace springproof::compare
