#include "compare/solve/answer_bytes.hpp"

#include "compare/solve/fields.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace springproof::compare {

namespace {

bool are_finite(const std::vector<Eigen::Vector3d>& displacement) {
  return std::all_of(displacement.begin(), displacement.end(),
                     [](const Eigen::Vector3d& u) { return u.allFinite(); });
}

bool are_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

bool are_finite(const std::vector<cases::SymmetricTensor>& tensors) {
  return std::all_of(tensors.begin(), tensors.end(), [](const cases::SymmetricTensor& tensor) {
    return std::all_of(tensor.begin(), tensor.end(), [](double value) { return std::isfinite(value); });
  });
}

/// As many finite values as the share has nodes and cells, where there are any.
bool fit(const std::optional<cases::Fields>& fields, const cases::Share& share) {
  if (!fields) return true;
  const auto& [reaction, total_energy, has_stress, energy, stress, strain] = *fields;
  const std::size_t n_of_stress = has_stress ? share.cells.size() : 0;
  return reaction.size() == share.nodes.size() && energy.size() == n_of_stress &&
         stress.size() == n_of_stress && strain.size() == share.cells.size() && std::isfinite(total_energy) &&
         are_finite(reaction) && are_finite(energy) && are_finite(stress) && are_finite(strain);
}

/// Whether a motion is one of a body with that many nodes at least.
bool is_sound(const cases::Trajectory& motion, std::size_t n_nodes) {
  const std::size_t n = motion.time.size();
  const auto is_node = [&](int node) { return node >= 0 && cases::index(node) < n_nodes; };
  const auto is_body = [&](const cases::Trajectory::Body& body) {
    return body.step >= 0 && cases::index(body.step) < n && body.displacement.size() >= n_nodes &&
           are_finite(body.displacement);
  };
  return n > 0 && motion.displacement.size() == n * motion.nodes.size() &&
         (motion.volume.empty() || motion.volume.size() == n) &&
         (!motion.slowest || (motion.slowest->omega > 0 && std::isfinite(motion.slowest->omega) &&
                              std::isfinite(motion.slowest->damping_ratio))) &&
         std::is_sorted(motion.time.begin(), motion.time.end()) &&
         std::is_sorted(motion.nodes.begin(), motion.nodes.end()) && are_finite(motion.time) &&
         are_finite(motion.displacement) && are_finite(motion.volume) &&
         std::all_of(motion.nodes.begin(), motion.nodes.end(), is_node) &&
         std::all_of(motion.bodies.begin(), motion.bodies.end(), is_body);
}

/// @throws std::runtime_error if a solution has not as many values as the share has nodes and cells
void check(const cases::Solution& solution, const cases::Share& share) {
  const auto is_empty_or = [&](std::size_t size, std::size_t expected) {
    return size == expected || (size == 0 && solution.status != cases::Status::converged);
  };
  const bool is_finite = are_finite(solution.displacement) && are_finite(solution.cell_volume);
  const bool is_moved = !solution.trajectory || is_sound(*solution.trajectory, share.nodes.end);
  if (!fit(solution.fields, share))
    throw std::runtime_error("has fields that are not those of the case's mesh");
  if (!is_empty_or(solution.displacement.size(), share.nodes.size()) ||
      !is_empty_or(solution.cell_volume.size(), share.cells.size()) || !is_finite || !is_moved)
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
